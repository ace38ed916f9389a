"""Make the data files in archgen/link/ros_interfaces/: which ROS interfaces each distribution has.

Run `python tools/make_ros_interfaces.py`; it needs the package rosbags. For each distribution two files are made:

- `NAME.names.json`: package -> {"whole": true or false, "patch": true, "msg": [...], "srv": [...], "action": [...]};
- `NAME.fields.json`: message -> its fields, as in a definition (`float64[36] covariance`), for the core messages.

Names come from ros_interfaces.yaml beside this script and from rosbags' type stores, fields from the type stores. A
package is whole where ros_interfaces.yaml read it at the released version; only of such a package may archgen say of any
name that it is wrong. With `patch` it was read at an earlier patch release (5.9.2, and 5.9.3 is released): of such a
package archgen says it only of slips. Of rolling, nothing is whole: its names are rosbags' core messages of lyrical and
what ros_interfaces.yaml lists for rolling, and rolling moves.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml
from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_typestore

HERE = Path(__file__).resolve().parent
TARGET = HERE.parent / "archgen" / "link" / "ros_interfaces"
STORES = {
    "noetic": Stores.ROS1_NOETIC,
    "humble": Stores.ROS2_HUMBLE,
    "jazzy": Stores.ROS2_JAZZY,
    "kilted": Stores.ROS2_KILTED,
    "lyrical": Stores.ROS2_LYRICAL,
    "rolling": Stores.ROS2_LYRICAL,
}
KINDS = ("msg", "srv", "action")
OF_ACTION = ("Action", "ActionGoal", "ActionResult", "ActionFeedback", "Goal", "Result", "Feedback")
"""What noetic's genaction makes of an action X: the messages XAction, XActionGoal, ..."""
ROS1_BUILTIN = {"builtin_interfaces/msg/Time": "time", "builtin_interfaces/msg/Duration": "duration"}
FILLER = "structure_needs_at_least_one_member"
"""The field that rosbags puts into empty messages."""


def fields(distro: str) -> dict[str, list[str]]:
    """Give the fields of the messages that rosbags holds for a distribution."""
    definitions = get_typestore(STORES[distro]).fielddefs
    found = {
        name: [f"{spell(node, distro)} {field}" for field, node in parts if field != FILLER]
        for name, (_, parts) in sorted(definitions.items())
    }
    return {name: texts for name, texts in found.items() if distro != "noetic" or name not in ROS1_BUILTIN}


def spell(node: tuple[int, Any], distro: str) -> str:
    """Write a type of rosbags (kind, details) as it stands in a definition."""
    kind, details = node
    if kind == Nodetype.BASE:
        name, bound = details
        return f"{name}<={bound}" if bound else str(name)
    if kind == Nodetype.NAME:
        return ROS1_BUILTIN.get(details, details) if distro == "noetic" else str(details)
    element, size = details
    limit = str(size) if kind == Nodetype.ARRAY else f"<={size}" if size else ""
    return f"{spell(element, distro)}[{limit}]"


def names(distro: str, listed: dict[str, dict[str, dict[str, list[str]]]]) -> dict[str, dict[str, object]]:
    """Give the packages of a distribution with their names."""
    found = dict[str, dict[str, set[str]]]()
    whole, patch = set[str](), set[str]()
    for package, distros in listed.items():
        entry = distros.get(distro)
        if entry is not None:
            found[package] = {kind: set(entry.get(kind, ())) for kind in KINDS}
            if "seen" not in entry and distro != "rolling":
                whole.add(package)
            elif "seen" in entry and distro != "rolling" and minor(str(entry["seen"])) == minor(str(entry["released"])):
                patch.add(package)
            if distro == "noetic":
                found[package]["msg"] |= {action + end for action in found[package]["action"] for end in OF_ACTION}
    for message in fields(distro):
        package, kind, name = message.split("/")
        found.setdefault(package, {kind: set() for kind in KINDS})[kind].add(name)
    return {
        package: {"whole": package in whole, **({"patch": True} if package in patch else {}), **sorted_kinds(kinds)}
        for package, kinds in sorted(found.items())
    }


def minor(version: str) -> list[str]:
    """Return a version without what counts its patches: 5.9 of 5.9.2."""
    return version.split(".")[:2]


def sorted_kinds(kinds: dict[str, set[str]]) -> dict[str, object]:
    """Sort the names of one package by kind; kinds that it has none of are left out."""
    return {kind: sorted(kinds[kind]) for kind in KINDS if kinds[kind]}


def rows(data: dict[str, object]) -> str:
    """Write JSON with one entry a line, so that a difference shows what changed."""
    lines = ",\n".join(f"{json.dumps(key)}: {json.dumps(value)}" for key, value in data.items())
    return f"{{\n{lines}\n}}\n"


def build() -> Iterator[tuple[str, str]]:
    """Give the name and the text of each data file."""
    listed = yaml.safe_load((HERE / "ros_interfaces.yaml").read_text(encoding="utf-8"))
    for distro in STORES:
        yield f"{distro}.names.json", rows(dict(names(distro, listed)))
        if distro != "rolling":  # its fields are lyrical's
            yield f"{distro}.fields.json", rows(dict(fields(distro)))


def main() -> None:
    """Write the files."""
    parser = argparse.ArgumentParser(description="Make archgen's data about ROS interfaces.")
    parser.add_argument("-o", "--output", type=Path, default=TARGET, help="the folder to write into")
    folder = parser.parse_args().output
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in build():
        (folder / name).write_text(text, encoding="utf-8", newline="\n")
        print(folder / name)


if __name__ == "__main__":
    main()
