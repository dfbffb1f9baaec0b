"""How far a run is, by the files in its directory."""

import fcntl
import json

DONE, DOUBTFUL, RUNNING, STOPPED, KILLED, FAILED, WAITING = (
    "done", "doubtful", "running", "stopped", "killed", "failed", "waiting")
CONDITIONS = (DONE, DOUBTFUL, RUNNING, STOPPED, KILLED, FAILED, WAITING)


def record(directory):
    """run.json; {} before it is there, and if it is damaged."""
    try:
        found = json.loads((directory / "run.json").read_text())
        return found if isinstance(found, dict) else {}
    except (OSError, ValueError):
        return {}


def state(directory):
    """What run.json says: "done", "stopped", "failed", "running" (or killed), "" before it begins."""
    return record(directory).get("state", "")


def doubts(directory):
    """Why the run is not to be trusted, or what it did not reach; [] for a good run, and before it is done."""
    found = record(directory)
    return found.get("doubts", []) if found.get("state") == DONE else []


def condition(directory):
    """One of CONDITIONS: the state, and whether anybody is at it. Where there are no locks, a running one counts as
    killed; one that lacks its case counts as stopped: `softgrain run --resume` goes on with both."""
    found = record(directory)
    said = found.get("state", WAITING)
    if said in (DONE, FAILED) and not (directory / "case.toml").exists():
        return STOPPED
    if said == DONE:
        return DOUBTFUL if found.get("doubts") else DONE
    if said == RUNNING:
        return RUNNING if is_locked(directory) else KILLED
    return said


def is_locked(directory):
    """Whether a process runs here; False too where the file system has no locks."""
    try:
        with open(directory / ".lock") as file:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:
        pass
    return False
