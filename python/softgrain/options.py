"""The options of the verbs that Python carries out: one table, options.json, from which the program and Python both read."""

import argparse
import json
from pathlib import Path


def parse(verb: str, words=None) -> argparse.Namespace:
    """What stands after `softgrain VERB`. An option has the name of its long form, a positional that of the table in
    small letters. Ends the program with exit code 2 on a mistake."""
    table = json.loads(Path(__file__).with_name("options.json").read_text(encoding="utf-8"))[verb]
    parser = argparse.ArgumentParser(prog=f"softgrain {verb}", description=table["text"])
    for option in table["options"]:
        parser.add_argument(*_names(option), **_look(option))
    found = parser.parse_args(words)
    for option in table["options"]:
        for other in option.get("excludes", ()):
            if _given(found, option["names"][-1]) and _given(found, other):
                parser.error(f"{option['names'][-1]} excludes {other}")
    return found


def _given(found, name):
    value = getattr(found, name.lstrip("-").replace("-", "_").lower())
    return value is not None and value is not False


def _names(option):
    return [name if name.startswith("-") else name.lower() for name in option["names"]]


def _look(option):
    flag = "value" not in option and option["names"][0].startswith("-")
    look = {"help": option["text"].replace("%", "%%")}
    if flag:
        return {**look, "action": "store_true"}
    positional = not option["names"][0].startswith("-")
    many, required = option.get("many", False), option.get("required", False)
    look["type"] = {"count": count, "index": int, "integer": int}.get(option.get("kind"), str)
    look["metavar"] = option["names"][0] if positional else option["value"]
    if "choices" in option:
        look["choices"] = option["choices"]
    if positional:
        look |= {"nargs": "+" if many else None if required else "?"}
    elif many:
        look |= {"action": "append", "default": [], "required": required}
    else:
        look["required"] = required
    if "default" in option:
        look["default"] = option["default"]
    return look


def count(word: str) -> int:
    """A whole number, at least 1."""
    number = int(word)
    if number < 1:
        raise argparse.ArgumentTypeError(f"must be a whole number, at least 1, got {word}")
    return number
