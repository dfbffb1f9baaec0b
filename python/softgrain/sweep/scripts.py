"""Scripts that carry out a sweep: a Slurm array, a Snakefile. A task is `softgrain sweep DIR/plan.toml --index I`."""

import re
import shlex
import subprocess

MAX_ARRAY_SIZE = 1001  # Slurm's own, where the scheduler cannot be asked

SLURM = """\
#!/bin/bash
# {count} runs, {pack} in a task. Submit with: {submit}
#SBATCH --job-name={job}
#SBATCH --array={array}
#SBATCH --cpus-per-task=1
#SBATCH --time=24:00:00
#SBATCH --output={output}
# Two minutes before the time is over the runs write a snapshot and ask with exit code 75 to come again.
#SBATCH --signal=USR2@120
#SBATCH --requeue
#SBATCH --open-mode=append

cpus="${{SLURM_CPUS_PER_TASK:-1}}"
export OMP_NUM_THREADS={threads}
task=$((${{1:-0}} + SLURM_ARRAY_TASK_ID))
srun --cpus-per-task="$cpus" {command} --index "$task"
code=$?
if [ "$code" -eq 75 ]; then
  scontrol requeue "$SLURM_JOB_ID"
fi
exit "$code"
"""

SUBMIT = """\
#!/bin/bash
# {count} tasks, more than one array may have here (MaxArraySize {size}): {parts} arrays{after}.
# Carry out with: bash {script}
set -e
{lines}
"""

SNAKEFILE = """\
# {count} runs. Carry out with: snakemake -s {script} --cores 2
# Exit code 5: done, but doubtful, as results.csv says. A run that was interrupted goes on from its last snapshot: what
# marks it as done is a file of its own.
from pathlib import Path

FOLDER = Path({folder!r})
COMMAND = {command!r}
TABLE = {table!r}
RUNS = {{name: index for index, name in enumerate({names!r})}}


rule all:
    input: FOLDER / "results.csv"


rule run:
    output: touch(FOLDER / "done" / "{{name}}")
    params: index=lambda wildcards: RUNS[wildcards.name]
    threads: 1
    shell: "OMP_NUM_THREADS={{threads}} {{COMMAND}} --index {{params.index}} || [ $? -eq 5 ]"


rule results:
    input: expand(FOLDER / "done" / "{{name}}", name=RUNS)
    output: FOLDER / "results.csv"
    shell: "{{TABLE}} || [ $? -eq 5 ]"
"""


def slurm_scripts(plan, words, pack, throttle, size):
    """{file name: text}: array.sh, and submit.sh where one array may not have so many tasks; the last is what to call.

    `words`: the command of a task, absolute. `throttle`: tasks at a time, None for as many as there is room for."""
    folder = plan.folder.resolve()
    tasks = -(-len(plan.runs) // pack)
    at_once = f"%{throttle}" if throttle else ""
    arrays = [f"0-{min(size, tasks - first) - 1}{at_once}" for first in range(0, tasks, size)]
    array_path, submit_path = folder / "array.sh", folder / "submit.sh"
    submit = f"bash {shlex.quote(str(submit_path))}" if len(arrays) > 1 else f"sbatch {shlex.quote(str(array_path))}"
    output = str(folder).replace("%", "%%") + "/slurm-%A_%a.txt"  # % begins what Slurm replaces
    files = {"array.sh": SLURM.format(
        count=len(plan.runs), pack=pack, submit=submit, array=arrays[0], job=_quoted(folder.name),
        output=_quoted(output), threads='"$cpus"' if pack == 1 else "1",
        command=shlex.join(words) + ("" if pack == 1 else ' --jobs "$cpus"'))}
    if len(arrays) > 1:
        # One after another, where only so many tasks may run at a time.
        follow = ["", *['--dependency=afterany:"$job" '] * (len(arrays) - 1)] if throttle else [""] * len(arrays)
        script = shlex.quote(str(array_path))
        lines = [f"job=$(sbatch --parsable --array={array} {after}{script} {part * size})\necho \"$job\""
                 for part, (array, after) in enumerate(zip(arrays, follow))]
        files["submit.sh"] = SUBMIT.format(
            count=tasks, size=size, parts=len(arrays), script=shlex.quote(str(submit_path)),
            after=", one after another" if throttle else "", lines="\n".join(lines))
    return files


def max_array_size():
    """How many tasks one array may have, as this scheduler says."""
    try:
        said = subprocess.run(["scontrol", "show", "config"], capture_output=True, text=True, timeout=20).stdout
    except (OSError, subprocess.TimeoutExpired):
        return MAX_ARRAY_SIZE
    found = re.search(r"^MaxArraySize\s*=\s*(\d+)", said, re.MULTILINE)
    return max(1, int(found[1])) if found else MAX_ARRAY_SIZE


def _quoted(text):
    """For a line of #SBATCH, which Slurm parts at blanks as a shell would."""
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"' if re.search(r"[^\w@%+=:,./-]", text) else text


def snakefile(plan, task_words, table_words):
    names = [run.name for run in plan.runs]
    folder = plan.folder.resolve()
    return SNAKEFILE.format(
        count=len(names), folder=str(folder), command=shlex.join(task_words), table=shlex.join(table_words),
        names=names, script=shlex.quote(str(folder / "Snakefile")))
