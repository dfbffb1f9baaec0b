#!/usr/bin/env python3
"""Which sources can be compiled as one: most of the time of a compiler goes into headers, anew for every source.

    tools/joint_sources.py LINES SOURCE... [-- SOURCE...]    prints "NUMBER SOURCE" for each: those of one number are one joint

A joint source has at most LINES lines. -- keeps the sources before it from those behind it. Sources with a name in common
in their anonymous namespaces, or that instantiate the same, are not joined; nor is one whose hidden name stands in a header
of src/, or of tests/, that another one of that folder includes.
"""
import functools
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
HIDDEN = re.compile(r"^namespace \{$(.*?)^\}  // namespace$", re.M | re.S)
# a name that a line without indentation defines: type, alias, function, variable
DEFINED = re.compile(r"^(?:struct|class|enum class|using|concept) (\w+)|^[\w:].*?[ &*>](\w+)(?:\(|\{| = |;|\[)", re.M)
# what is instantiated: RigidDynamics<2>, or RigidDynamics<2>::friction_work
INSTANTIATED = re.compile(r"^template (?:(?:class|struct) (\w+<[^<>]*>)|(?!<)[^(;]*?(\w+<[^<>]*>[^<(;\s]*)[(;])", re.M)
TAKEN_IN = re.compile(r"^using [\w:]*::(\w+);", re.M)
INCLUDED = re.compile(r'^#include "([\w/]+\.hpp)"', re.M)


def defined(text):
    constants = {name for line in re.findall(r"^(?:inline )?const\w* .*", text, re.M) for name in re.findall(r"(\w+) = ", line)}
    return constants | {name for names in DEFINED.findall(text) for name in names if name}


def own_names(text):
    """Names that a source hides or takes in."""
    hidden = {name for block in HIDDEN.findall(text) for name in defined(block)}
    return hidden | set(TAKEN_IN.findall(text))


@functools.cache
def names_in(header):
    """Names of a header and of those that it includes, in any depth."""
    text = header.read_text()
    return defined(text).union(*map(names_in, headers_of(header, text)))


def headers_of(source, text):
    """Headers that a source includes from its own folder of the project: src/ or tests/."""
    top = ROOT / source.resolve().relative_to(ROOT).parts[0]
    for name in INCLUDED.findall(text):
        places = (folder / name for folder in (top, source.parent))
        yield from [place for place in places if place.is_file()][:1]


class Joint:
    def __init__(self):
        self.sources, self.lines, self.own, self.shared, self.made = [], 0, set(), set(), set()

    def takes(self, lines, own, shared, made, longest):
        # a class makes its members, too
        twice = any(a.startswith(b) or b.startswith(a) for a in self.made for b in made)
        apart = not (self.own & (own | shared)) and not (self.shared & own) and not twice
        return apart and (not self.sources or self.lines + lines <= longest)


def joints(sources, longest):
    """Lists of sources that can be compiled as one."""
    found = []
    for source in sorted(sources):
        text = Path(source).read_text()
        lines, own = text.count("\n"), own_names(text)
        shared = set().union(*map(names_in, headers_of(Path(source), text)))
        made = set(map("".join, INSTANTIATED.findall(text)))
        joint = next((joint for joint in found if joint.takes(lines, own, shared, made, longest)), None)
        if joint is None:
            found.append(joint := Joint())
        joint.sources.append(source)
        joint.lines += lines
        joint.own |= own
        joint.shared |= shared
        joint.made |= made
    return [joint.sources for joint in found]


if __name__ == "__main__":
    lists = ("\n".join(sys.argv[2:]) + "\n").split("--\n")
    made = [joint for sources in lists for joint in joints(sources.splitlines(), int(sys.argv[1]))]
    for number, joint in enumerate(made):
        print("\n".join(f"{number} {source}" for source in joint))
