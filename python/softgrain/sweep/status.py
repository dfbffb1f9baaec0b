"""How far a sweep is: how many runs are done, failed, running; what remains, and for how long."""

from collections import Counter

from ..run import open_run
from .state import CONDITIONS, DONE, DOUBTFUL, FAILED, RUNNING, STOPPED, KILLED, WAITING, condition, record

BAR = 30  # characters
OVER = (DONE, DOUBTFUL, FAILED)
MOST_NAMED = 20
MEANING = {DOUBTFUL: "done, but not to be trusted: `softgrain info` tells why",
           STOPPED: "goes on when the sweep is called again",
           KILLED: "goes on from its last snapshot when the sweep is called again",
           FAILED: "--retry-failed tries it again", WAITING: "not begun"}


def status_text(plan):
    """What `softgrain sweep status` prints."""
    conditions = {run.name: condition(plan.directory(run)) for run in plan.runs}
    counts = Counter(conditions.values())
    begun = [run for run in plan.runs if conditions[run.name] not in (*OVER, WAITING)]
    under_way = {run.name: _way(plan.directory(run)) for run in begun}
    share = (sum(counts[name] for name in OVER) + sum(progress for progress, _ in under_way.values())) / len(plan.runs)
    lines = [f"{plan.folder}: {len(plan.runs)} runs, {100 * share:.1f} %  [{'=' * int(share * BAR):<{BAR}}]"]
    lines += [f"  {name:<9}{counts[name]:>7}   {MEANING.get(name, '')}".rstrip() for name in CONDITIONS if counts[name]]
    lines += _time_left(plan, conditions, under_way, counts)
    failed = [run for run in plan.runs if conditions[run.name] == FAILED]
    lines += [f"{run.name}: {_why(plan.directory(run))}" for run in failed[:MOST_NAMED]]
    if len(failed) > MOST_NAMED:
        lines.append(f"... and {len(failed) - MOST_NAMED} more failed")
    return "\n".join(lines)


def _way(directory):
    """(share of the path, wall time [s]) of a run on its way, by the rows of its series."""
    try:
        run = open_run(directory)
        rows = len(run.series["step"]) - 1  # the first is of the start
        return min(1.0, rows / run.case["output"]["samples"]), float(run.series["wall_seconds"][-1])
    except (OSError, ValueError, KeyError, IndexError):
        return 0.0, 0.0


def _time_left(plan, conditions, under_way, counts):
    """A run that is over says what one costs, or if there is none yet those on their way."""
    left = [1 - under_way.get(run.name, (0.0, 0.0))[0] for run in plan.runs if conditions[run.name] not in OVER]
    if not left:
        return []
    done = [run for run in plan.runs if conditions[run.name] in (DONE, DOUBTFUL)]
    costs = [record(plan.directory(run)).get("wall_seconds", 0.0) for run in done]
    costs = costs or [seconds / progress for progress, seconds in under_way.values() if progress > 0]
    if not costs:
        return ["too early to say how long it will take"]
    cost = sum(costs) / len(costs)
    at_once = counts[RUNNING]
    if not at_once:
        return [f"nothing runs; {duration(sum(left) * cost)} of one run after another are left: "
                f"softgrain sweep {plan.folder}"]
    return [f"about {duration(max(sum(left) / at_once, max(left)) * cost)} left with {at_once} at a time"]


def duration(seconds):
    """"40 s", "12 min", "3 h 20 min", "2 d 4 h"."""
    minutes, hours, days = seconds / 60, seconds / 3600, seconds / 86400
    if seconds < 60:
        return f"{seconds:.0f} s"
    if minutes < 60:
        return f"{minutes:.0f} min"
    if hours < 24:
        return f"{int(hours)} h {int(minutes % 60)} min"
    return f"{int(days)} d {int(hours % 24)} h"


def _why(directory):
    return record(directory).get("message", "").partition("\n")[0] or "without a word"
