"""A run's directory as a research object: ro-crate-metadata.json after RO-Crate 1.1 and the profile Process Run Crate 0.5.

Sources: the RO-Crate 1.1 specification, "Root Data Entity" and "Data Entities"; the profile's table "Requirements"
(https://w3id.org/ro/wfrun/process/0.5)."""

import json
import os
import shlex
import uuid
from datetime import datetime, timezone
from urllib.parse import quote

NAME = "ro-crate-metadata.json"
CRATE = "https://w3id.org/ro/crate/1.1"
PROFILE = "https://w3id.org/ro/wfrun/process/0.5"
CONTEXT = [f"{CRATE}/context", "https://w3id.org/ro/terms/workflow-run/context"]
NO_LICENSE = "No licence is stated: ask who made this run before you use it."
INPUTS = {"case.toml": ("The resolved case: every quantity that the run was made of, in SI", "application/toml")}
OUTPUTS = {"series.csv": ("Observables over time, a column each with its unit", "text/csv"),
           "run.json": ("What ran: program, command, machine, verdict", "application/json"),
           "log.txt": ("What the run has said", "text/plain"),
           "report.html": ("The run in motion, for any browser", "text/html"),
           "run.pvd": ("The times of the files in vtk/, for ParaView", "application/xml")}
FOLDERS = {"snap": "The state at chosen times, HDF5: scene to draw, checkpoint to go on from",
           "vtk": "Particles, contacts and walls at these times, VTK's PolyData"}
LATER = {"figures": "Figures that softgrain plot has drawn", "export": "Snapshots in formats of other programs"}
STATES = {"done": "CompletedActionStatus", "running": "ActiveActionStatus"}  # others have failed


def write_rocrate(run, license=None, author=None):
    """Writes RUN/ro-crate-metadata.json; returns its path. Raises ValueError where run.json does not say what ran."""
    if "program" not in run.info:
        raise ValueError(f"{run.path} has no run.json that says what ran: a crate would have nothing to tell")
    graph = graph_of(run, license or NO_LICENSE, author, datetime.now(timezone.utc))
    path = run.path / NAME
    temporary = path.with_name(NAME + ".tmp")
    temporary.write_text(json.dumps({"@context": CONTEXT, "@graph": graph}, indent=2, ensure_ascii=False) + "\n",
                         encoding="utf-8")
    return temporary.replace(path)


def graph_of(run, license, author, now):
    """The entities: the crate, its profile, the program, the execution, the files that are there, licence and author."""
    inputs = [_file(run.path, *item) for item in INPUTS.items() if (run.path / item[0]).exists()]
    outputs = [_file(run.path, *item) for item in OUTPUTS.items() if (run.path / item[0]).exists()]
    outputs += [_folder(*item) for item in FOLDERS.items() if (run.path / item[0]).is_dir()]
    later = [_folder(*item) for item in LATER.items() if (run.path / item[0]).is_dir()]
    program, people = _program(run), _people(author)
    action = _action(run, program, inputs, outputs, people)
    terms = _terms(license)
    root = {"@id": "./", "@type": "Dataset", "conformsTo": _link(PROFILE), "name": f"softgrain run {run.name}",
            "description": _summary(run), "datePublished": now.date().isoformat(),
            "license": _link(terms[0]["@id"]) if terms else license, "hasPart": _links(inputs + outputs + later),
            "mentions": _link(action["@id"])}
    if people:
        root["author"] = _link(people[0]["@id"])
    descriptor = {"@id": NAME, "@type": "CreativeWork", "conformsTo": _link(CRATE), "about": _link("./")}
    profile = {"@id": PROFILE, "@type": "CreativeWork", "name": "Process Run Crate", "version": "0.5"}
    return [descriptor, root, profile, program, action, *inputs, *outputs, *later, *people, *terms]


def _summary(run):
    """What was done to what."""
    experiment = run.case.get("experiment", {})
    words = [f"{key} {experiment[key]}" for key in ("loading", "model") if key in experiment]
    verdict = run.info.get("verdict", "")
    return ", ".join(["Simulation of soft granular matter", *words]) + (f". {verdict[:1].upper()}{verdict[1:]}" if verdict else "")


def _program(run):
    """The tool; the version alone, with the commit beside it."""
    program = run.info["program"]
    about = ", ".join(f"{name} {program[name]}" for name in ("commit", "compiler") if program.get(name))
    return {"@id": "#softgrain", "@type": "SoftwareApplication", "name": "softgrain", "softwareVersion": program["version"],
            "description": f"Simulation of soft granular matter by nonsmooth contact dynamics; {about}"}


def _action(run, program, inputs, outputs, people):
    """The execution. Its identifier follows from when and how it began: one run has the same in every crate."""
    info = run.info
    seed = f"softgrain {info.get('started', '')} {shlex.join(info.get('command', []))}"
    action = {"@id": f"urn:uuid:{uuid.uuid5(uuid.NAMESPACE_URL, seed)}", "@type": "CreateAction",
              "name": f"softgrain run of {run.name}", "description": shlex.join(info.get("command", [])) or "softgrain run",
              "instrument": _link(program["@id"]), "object": _links(inputs), "result": _links(outputs),
              "actionStatus": f"http://schema.org/{STATES.get(info.get('state'), 'FailedActionStatus')}"}
    for time, name in (("startTime", "started"), ("endTime", "updated")):
        if name in info:
            action[time] = info[name]
    if action["actionStatus"].endswith("FailedActionStatus") and info.get("message"):
        action["error"] = info["message"]
    if people:
        action["agent"] = _link(people[0]["@id"])
    return action


def _file(folder, name, about):
    description, form = about
    return {"@id": quote(name), "@type": "File", "name": name, "description": description, "encodingFormat": form,
            "contentSize": str(os.path.getsize(folder / name))}


def _folder(name, description):
    return {"@id": f"{quote(name)}/", "@type": "Dataset", "name": name, "description": description}


def _people(author):
    """A person, by an address (an ORCID) or a name; none where nobody is named."""
    if not author:
        return []
    address = author.startswith(("http://", "https://"))
    return [{"@id": author if address else "#author", "@type": "Person", "name": author}]


def _terms(license):
    """An entity of a licence that has an address; words stand for themselves."""
    if not license.startswith(("http://", "https://")):
        return []
    return [{"@id": license, "@type": "CreativeWork", "name": license.rstrip("/").rpartition("/")[2],
             "description": f"The licence at {license}"}]


def _link(identifier):
    return {"@id": identifier}


def _links(entities):
    return [_link(entity["@id"]) for entity in entities]
