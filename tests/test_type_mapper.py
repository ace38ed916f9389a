"""The shipped type mapper: every entry exists in every distribution that it is for."""

from __future__ import annotations

import json
import unicodedata
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

import jsonschema_rs
import numpy as np
import pytest
import yaml
from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_typestore
from rosbags.typesys.store import Typestore

from archgen.link.interface_sources import load_interfaces
from archgen.link.project_types import load_shipped_types
from archgen.model.message_types import full_message_name

ROOT = Path(__file__).resolve().parents[1]
DISTROS = ("noetic", "humble", "jazzy", "kilted")
SCHEMA = json.loads((ROOT / "schemas" / "ros_type_mapper.schema.json").read_text(encoding="utf-8"))
ENTRIES: dict[str, dict[str, Any]] = yaml.safe_load((ROOT / "ros_type_mapper.yaml").read_text(encoding="utf-8"))[
    "types"
]


def test_the_schema_takes_the_file() -> None:
    jsonschema_rs.meta.validate(SCHEMA)
    assert [error.message for error in jsonschema_rs.validator_for(SCHEMA).iter_errors({"types": ENTRIES})] == []


def test_the_schema_explains_every_key() -> None:
    def keys(part: object) -> list[dict[str, Any]]:
        if isinstance(part, list):
            return [key for item in part for key in keys(item)]
        if not isinstance(part, dict):
            return []
        own = [value for value in part.get("properties", {}).values() if "$ref" not in value]
        return own + [key for value in part.values() for key in keys(value)]

    found = keys(SCHEMA)
    assert len(found) == 5
    assert [key for key in found if not {"title", "description", "examples"} <= set(key)] == []


@pytest.mark.parametrize(
    "broken",
    [
        {"message": "sensor_msgs/Image"},
        {"message": "sensor_msgs/msg/Image", "size": "12 kb"},
        {"message": "sensor_msgs/msg/Image", "distro": {}},
        {"comment": "no message"},
    ],
)
def test_the_schema_refuses(broken: dict[str, Any]) -> None:
    assert not jsonschema_rs.validator_for(SCHEMA).is_valid({"types": {"Thing": broken}})


def test_there_are_many_and_their_names_are_in_normal_form() -> None:
    assert len(ENTRIES) >= 75
    for name in ENTRIES:
        assert name == " ".join(unicodedata.normalize("NFC", name).split())
        assert name[0].isupper()
        assert full_message_name(name) is None


@pytest.mark.parametrize("distro", DISTROS)
def test_every_entry_is_known(distro: str) -> None:
    interfaces, _ = load_interfaces(distro)
    types = load_shipped_types(distro)
    unknown = {
        name: type_.message for name, type_ in types.items() if interfaces.status_of(type_.message or "") != "known"
    }
    assert unknown == {}
    assert list(types) == [name for name, entry in ENTRIES.items() if distro not in entry.get("without", ())]


@pytest.mark.parametrize("distro", DISTROS)
def test_exceptions_are_needed(distro: str) -> None:
    """An exception for a distribution that has the plain message after all would hide it."""
    interfaces, _ = load_interfaces(distro)
    for name, entry in ENTRIES.items():
        if distro in entry.get("without", ()):
            assert interfaces.status_of(entry["message"]) != "known", name
    named = {d for entry in ENTRIES.values() for d in (*entry.get("without", ()), *entry.get("distros", {}))}
    assert named <= set(DISTROS)


def test_a_distribution_may_have_another_message() -> None:
    messages = {
        distro: load_shipped_types(distro)["Navigation goal"].message for distro in ("noetic", "jazzy", "foxy", None)
    }
    assert messages == {
        "noetic": "move_base_msgs/action/MoveBase",
        "jazzy": "nav2_msgs/action/NavigateToPose",
        "foxy": "nav2_msgs/action/NavigateToPose",
        None: "nav2_msgs/action/NavigateToPose",
    }
    assert "Docking" not in load_shipped_types("humble")


def serialised(store: Typestore, message: str) -> int | None:
    """Give the bytes of a message with a short frame name, None where its size depends on what is in it."""
    if message not in store.fielddefs or any(node[0] == Nodetype.SEQUENCE for node in leaves(store, message)):
        return None
    return len(store.serialize_cdr(made(store, message), message))


def leaves(store: Typestore, message: str) -> Iterator[tuple[Any, Any]]:
    for _, node in store.fielddefs[message][1]:
        yield from leaves(store, node[1]) if node[0] == Nodetype.NAME else [node]


def made(store: Typestore, message: str) -> object:
    return store.types[message](**{name: value(store, node) for name, node in store.fielddefs[message][1]})


def value(store: Typestore, node: tuple[Any, Any]) -> Any:  # noqa: ANN401  # whatever a field may hold
    kind, details = node
    if kind == Nodetype.NAME:
        return made(store, details)
    if kind == Nodetype.ARRAY:
        return np.zeros(details[1], dtype=details[0][1][0])
    return {"string": "base_link", "bool": False}.get(details[0], 0.0 if details[0].startswith("float") else 0)


def test_sizes_are_those_of_the_serialised_messages() -> None:
    store = get_typestore(Stores.ROS2_JAZZY)
    compared = dict[str, tuple[Fraction, int]]()
    for name, type_ in load_shipped_types("jazzy").items():
        size = serialised(store, type_.message or "")
        if type_.size and size:
            compared[name] = (type_.size.value, size)
    assert len(compared) > 20
    assert {name: sizes for name, sizes in compared.items() if sizes[0] != sizes[1]} == {}


def test_an_entry_is_a_type() -> None:
    scan = load_shipped_types("jazzy")["Laser scan"]
    assert (scan.name, scan.message, scan.origin) == ("Laser scan", "sensor_msgs/msg/LaserScan", "shipped")
    assert (scan.comment, scan.size and scan.size.value) == ("720 beams with intensities", Fraction(5800))
