"""Contacts as a table: who pushes whom, where, in which direction and how hard."""

import numpy as np

from .. import solids
from ..run import NotRecorded, Snapshot

PLACES = {"x": "m", "y": "m", "z": "m"}
FORCES = ("normal_force", "tangential_force", "force_x", "force_y", "force_z")


def contact_table(snapshot: Snapshot) -> dict[str, np.ndarray]:
    """Columns, one row for each contact that pushes:

    a, b               the two particles of bonded grains, or the two elastic grains; b is -1 for a wall
    wall               0 bottom, 1 top, 2 left, 3 right, in space 2 and 3 across y, 4 and 5 across x; -1 for none
    grain_a, grain_b   their grains; grain_b is -1 for a wall
    kind_a, kind_b     the kinds of these, from 0; kind_b is -1 for a wall; left out where there is one kind
    normal_x, normal_y unit vector from a to b
    x, y               where they touch [m]
    normal_force       [N/m], positive
    tangential_force   [N/m], of a on b along e_z x normal; left out where it was not recorded

    In space also normal_z and z, forces are in N, tangential_force is a length, and force_x, force_y, force_z are the
    whole force of a on b.

    Raises NotRecorded where the snapshot has no contacts."""
    contacts = snapshot.contacts
    if not {"pair", "force"} <= contacts.keys():
        raise NotRecorded(f"the snapshot of step {snapshot.step} has no contacts")
    a, b = contacts["pair"].astype(int).T
    count = len(snapshot.bodies())
    wall = np.where(b < count, -1, b - count)
    b = np.where(wall < 0, b, -1)
    owner = np.arange(count) if snapshot.contacts_of_grains else snapshot.particles.get("grain", np.zeros(count, int))
    normal, place = _geometry(snapshot, a, b, wall)
    axes = "xyz"[:normal.shape[1]]
    table = dict(a=a, b=b, wall=wall, grain_a=owner[a].astype(int), grain_b=np.where(wall < 0, owner[b], -1).astype(int),
                 **{f"normal_{axis}": column for axis, column in zip(axes, normal.T)}, **dict(zip(axes, place.T)),
                 normal_force=contacts["force"])
    kind = snapshot.particles.get("kind")
    if kind is not None:
        grains, first = np.unique(snapshot.particles["grain"].astype(int), return_index=True)
        of_grain = dict(zip(grains, kind[first].astype(int)))
        for side in "ab":
            table[f"kind_{side}"] = np.array([of_grain.get(grain, -1) for grain in table[f"grain_{side}"]], int)
    if solids.in_space(snapshot):
        force = contacts["total_force"]
        table["tangential_force"] = np.linalg.norm(force - (force * normal).sum(axis=1)[:, None] * normal, axis=1)
        table |= {f"force_{axis}": column for axis, column in zip(axes, force.T)}
    elif "total_force" in contacts:
        table["tangential_force"] = (contacts["total_force"] * np.column_stack([-normal[:, 1], normal[:, 0]])).sum(axis=1)
    elif "tangential_force" in contacts:
        table["tangential_force"] = contacts["tangential_force"]
    return table


def write_contacts(snapshot, file):
    """One line for each contact; the header names columns and units as in series.csv."""
    table = contact_table(snapshot)
    units = PLACES | dict.fromkeys(FORCES, "N" if solids.in_space(snapshot) else "N/m")
    file.write(",".join(name + (f"[{units[name]}]" if name in units else "") for name in table) + "\n")
    columns = [[f"{value:.9g}" for value in values.tolist()] for values in table.values()]
    file.writelines(",".join(row) + "\n" for row in zip(*columns))


def _geometry(snapshot, a, b, wall):
    """Unit normals from a to b, and places; of disks they follow from the centres."""
    contacts = snapshot.contacts
    if snapshot.contacts_of_grains:
        return contacts["normal"], contacts["position"]
    position, radius = snapshot.particles["position"], snapshot.particles["radius"]
    normal = position[b] - position[a]
    for w in np.unique(wall[wall >= 0]):
        start, end = snapshot.walls[w].reshape(2, 2)
        across = np.array([start[1] - end[1], end[0] - start[0]])
        of_wall = wall == w
        normal[of_wall] = across * np.sign((start - position[a[of_wall]]) @ across)[:, None]
    normal /= np.hypot(*normal.T)[:, None]
    return normal, position[a] + radius[a, None] * normal
