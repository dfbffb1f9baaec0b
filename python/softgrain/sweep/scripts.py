"""Files that hand a sweep to others: a Slurm array and a Snakefile. Each task is `softgrain sweep --index I`."""

import re
import shlex

SLURM = """\
#!/bin/bash
# An array of {count} runs. Submit with: sbatch {script}
#SBATCH --job-name={job}
#SBATCH --array=0-{last}
#SBATCH --cpus-per-task=1
#SBATCH --time=24:00:00
#SBATCH --output={output}
# Two minutes before the time is over the run writes a snapshot and asks with exit code 75 to come again.
#SBATCH --signal=USR2@120
#SBATCH --requeue
#SBATCH --open-mode=append

export OMP_NUM_THREADS="${{SLURM_CPUS_PER_TASK:-1}}"
srun {command} --index "$SLURM_ARRAY_TASK_ID"
code=$?
if [ "$code" -eq 75 ]; then
  scontrol requeue "$SLURM_JOB_ID"
fi
exit "$code"
"""

SNAKEFILE = """\
# {count} runs. Carry out with: snakemake -s {script} --cores 2
# Exit code 5: done, but doubtful, as results.csv says. A run that was interrupted goes on from its last snapshot: what marks it as done is a file of its own.
from pathlib import Path

FOLDER = Path({folder!r})
COMMAND = {command!r}
RUNS = {names!r}


rule all:
    input: FOLDER / "results.csv"


rule run:
    output: touch(FOLDER / "done" / "{{name}}")
    params: index=lambda wildcards: RUNS.index(wildcards.name)
    threads: 1
    shell: "OMP_NUM_THREADS={{threads}} {{COMMAND}} --index {{params.index}} || [ $? -eq 5 ]"


rule results:
    input: expand(FOLDER / "done" / "{{name}}", name=RUNS)
    output: FOLDER / "results.csv"
    shell: "{{COMMAND}} || [ $? -eq 5 ]"
"""


def slurm_script(plan, words, script):
    """The text of the array's script; `words` are those of this sweep, absolute."""
    folder = plan.folder.resolve()
    count = len(plan.runs)
    output = str(folder).replace("%", "%%") + "/slurm-%a.txt"  # % begins what Slurm replaces
    return SLURM.format(count=count, last=count - 1, job=_quoted(folder.name), output=_quoted(output), script=shlex.quote(str(script)),
                        command=shlex.join(words))


def _quoted(text):
    """For a line of #SBATCH, which Slurm parts at blanks as a shell would."""
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"' if re.search(r"[^\w@%+=:,./-]", text) else text


def snakefile(plan, words, script):
    names = [run.name for run in plan.runs]
    return SNAKEFILE.format(count=len(names), folder=str(plan.folder.resolve()), command=shlex.join(words),
                            names=names, script=shlex.quote(str(script)))


def sweep_words(plan, columns):
    """The command line of this sweep with absolute paths, so that it can be called from anywhere."""
    words = [plan.program, "sweep", str(plan.case.resolve()), "-o", str(plan.folder.resolve())]
    words += [f"--set={word}" for word in plan.fixed]
    words += [f"--vary={key}={','.join(values)}" for key, values in plan.varied.items()]
    return words + [f"--column={name}" for name in columns]
