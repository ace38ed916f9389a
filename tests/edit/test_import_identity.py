"""Who is who between two imports: nodes by their names in ROS, components by their nodes, everything in the file where it stands."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pytest

from archgen.edit.import_identity import keep_files, keep_identities

Nodes = dict[str, Any]
LIDAR = {"package": "drv", "executable": "lidar"}
CAMERA = {"package": "drv", "executable": "camera"}


def keep(known: Nodes, now: Nodes, others: Nodes | None = None) -> tuple[Nodes, Mapping[str, str]]:
    """Return the nodes of one slice with the ids that are known, and what was renamed."""
    kept = keep_identities({"a.yaml": {"nodes": now}}, {"a.yaml": {"nodes": known}}, {"nodes": others or {}}, "launch")
    return kept.slices["a.yaml"]["nodes"], kept.renames


@pytest.mark.parametrize(
    ("known", "now", "kept", "renames"),
    [
        # Ids that follow the order of a launch file: the full names say who is who.
        (
            {"cam": {"namespace": "/left", **CAMERA}, "right_cam": {"namespace": "/right", "name": "cam", **CAMERA}},
            {"cam": {"namespace": "/right", **CAMERA}, "left_cam": {"namespace": "/left", "name": "cam", **CAMERA}},
            {"right_cam": {"name": "cam", "namespace": "/right", **CAMERA}, "cam": {"namespace": "/left", **CAMERA}},
            {},
        ),
        # Another namespace: the id says who it is.
        (
            {"lidar": LIDAR},
            {"lidar": {"namespace": "/front", **LIDAR}},
            {"lidar": {"namespace": "/front", **LIDAR}},
            {},
        ),
        # The one that runs the program.
        ({"lidar": LIDAR}, {"scanner": LIDAR}, {"lidar": {"name": "scanner", **LIDAR}}, {"nodes.lidar": "/scanner"}),
        # Two that run it are told apart by what they say to ROS, or not at all.
        (
            {"one": {**LIDAR, "publishes": {"a": "/a", "b": "/b"}}, "two": {**LIDAR, "publishes": {"c": "/c"}}},
            {"three": {**LIDAR, "publishes": {"a": "/a", "b": "/b"}}, "four": LIDAR},
            {"one": {"name": "three", **LIDAR, "publishes": {"a": "/a", "b": "/b"}}, "four": LIDAR},
            {"nodes.one": "/three"},
        ),
        ({"lidar": LIDAR}, {"camera": CAMERA}, {"camera": CAMERA}, {}),
        # Two of one name, which is the robot's fault: their programs say who is who.
        (
            {"one": {"name": "x", **LIDAR}, "two": {"name": "x", **CAMERA}},
            {"x": CAMERA, "x_2": {"name": "x", **LIDAR}},
            {"two": {"name": "x", **CAMERA}, "one": {"name": "x", **LIDAR}},
            {},
        ),
        # A new node whose id another one has, which is called otherwise.
        (
            {"cam": {"namespace": "/left", **CAMERA}},
            {"cam": {"namespace": "/right", **CAMERA}, "left_cam": {"namespace": "/left", "name": "cam", **CAMERA}},
            {"right_cam": {"name": "cam", "namespace": "/right", **CAMERA}, "cam": {"namespace": "/left", **CAMERA}},
            {},
        ),
    ],
)
def test_a_node_keeps_its_id(known: Nodes, now: Nodes, kept: Nodes, renames: dict[str, str]) -> None:
    assert keep(known, now) == (kept, renames)


@pytest.mark.parametrize(
    ("other", "kept"),
    [
        ({"front_lidar": {"name": "lidar"}}, "front_lidar"),
        # A file that only adds something to it.
        ({"lidar": {"host": "pc"}}, "lidar"),
        ({"lidar": {"namespace": "/rear"}}, "lidar_2"),
        ({"lidar": {"namespace": "/rear", "host": "pc"}}, "lidar_2"),
    ],
)
def test_a_node_has_the_id_that_other_files_of_the_project_give_it(other: Nodes, kept: str) -> None:
    assert list(keep({}, {"lidar": LIDAR}, other)[0]) == [kept]


GROUPS = {
    "drivers": {"components": {"lidar": {"outputs": {"scan": "Scan"}}, "guard": {"inputs": {"scan": "lidar.scan"}}}},
    "nav": {"components": {"map": {"inputs": {"scan": {"from": ["drivers.lidar.scan"]}}}}},
}
NODES = {"lidar": {"implements": "drivers.lidar", **LIDAR}, "guard": {"implements": "drivers.guard"}}


def test_a_component_stands_where_that_of_its_node_does_and_is_named_so() -> None:
    known = {"a.yaml": {"nodes": {"lidar": {"implements": "sensing.front", **LIDAR}}}}
    kept = keep_identities(
        {"a.yaml": {"groups": GROUPS, "nodes": NODES}},
        known,
        {},
        "launch",
        {("groups", "drivers", "components", "lidar", "outputs", "scan"): "why"},
    )
    data = kept.slices["a.yaml"]
    assert data["groups"] == {
        "sensing": {"components": {"front": {"outputs": {"scan": "Scan"}}}},
        "drivers": {"components": {"guard": {"inputs": {"scan": "sensing.front.scan"}}}},
        "nav": {"components": {"map": {"inputs": {"scan": {"from": ["sensing.front.scan"]}}}}},
    }
    assert data["nodes"]["lidar"]["implements"] == "sensing.front"
    assert kept.comments == {("groups", "sensing", "components", "front", "outputs", "scan"): "why"}
    assert kept.moves == {}


def test_an_element_stands_in_the_file_where_people_put_it() -> None:
    slices = {"a.yaml": {"groups": GROUPS, "nodes": NODES}}
    known = {"b.yaml": {"nodes": {"guard": {}}, "groups": {"nav": {"components": {"map": {}}}}}, "a.yaml": {}}
    kept = keep_files(slices, known)
    assert kept["b.yaml"] == {"groups": {"nav": GROUPS["nav"]}, "nodes": {"guard": NODES["guard"]}}
    assert kept["a.yaml"] == {"groups": {"drivers": GROUPS["drivers"]}, "nodes": {"lidar": NODES["lidar"]}}
