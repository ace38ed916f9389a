"""The table of formats that `archgen import` reads: each one's reader is imported when it is asked for."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from pathlib import Path

from archgen.frozen import dataclass
from archgen.importers.foreign.foreign_import import ForeignImport

ForeignReader = Callable[..., ForeignImport]
"""Takes the files, and by name the launch arguments and the known ids where its format has such."""


@dataclass(frozen=True, slots=True)
class ImportFormat:
    """A format: what it is, how its files end, and who reads it."""

    name: str
    summary: str
    """What it is, for `archgen import --help`."""
    endings: tuple[str, ...]
    """Endings of files that are of this format and of no other, in lower case."""
    reader: str
    """`module:function`; the function takes the files and returns a ForeignImport, or raises ForeignFileError."""
    takes_arguments: bool = False
    """Whether values of launch arguments may be given: `NAME:=VALUE`."""
    keeps_ids: bool = False
    """Whether the function takes `known_ids`, too: ids that elements have since an earlier import, by the other tool's."""

    def load_reader(self) -> ForeignReader:
        """Return the function that reads files of this format."""
        module, _, function = self.reader.partition(":")
        reader: ForeignReader = getattr(importlib.import_module(module), function)
        return reader


REQIF = "reqif"
"""Requirements go into a slice of a project that is there, so this format has a command of its own behind the verb."""

IMPORT_FORMATS: dict[str, ImportFormat] = {
    known.name: known
    for known in (
        ImportFormat(REQIF, "requirements of Doors, Polarion and others (.reqif, .reqifz)", (".reqif", ".reqifz"), ""),
        ImportFormat(
            "aadl", "models in AADL v2, as text (.aadl)", (".aadl",), "archgen.importers.aadl.aadl_import:read_aadl"
        ),
        ImportFormat(
            "xmi",
            "UML models in XMI 2 (.xmi, .uml, .mdzip): components, classes, nodes",
            (".xmi", ".uml", ".mdzip", ".zargo"),
            "archgen.importers.xmi:read_xmi",
            keeps_ids=True,
        ),
        ImportFormat(
            "nodl",
            "interfaces of nodes in the Node Definition Language, version 1 (XML) and 2 (YAML, JSON)",
            (".nodl.yaml", ".nodl.yml", ".nodl.json", ".nodl.xml"),
            "archgen.importers.nodl.nodl_import:read_nodl",
        ),
        ImportFormat(
            "launch",
            "nodes that exist, from launch files of ROS in XML, YAML and Python (which is never run)",
            (".launch", *(f"{mark}launch.{ending}" for mark in "._" for ending in ("xml", "py", "yaml", "yml"))),
            "archgen.importers.launch.launch_import:read_launch",
            takes_arguments=True,
        ),
        ImportFormat(
            "package",
            "packages of ROS: their programs, parameters and messages (package.xml, or a folder)",
            ("package.xml",),
            "archgen.importers.ros_package.package_import:read_packages",
        ),
        ImportFormat(
            "ros2",
            "a running robot, from what `ros2 node info` and its like print",
            (),
            "archgen.importers.running_graph.graph_import:read_ros_2_graph",
        ),
        ImportFormat(
            "ros1",
            "a running robot, from what `rosnode info` and its like print",
            (),
            "archgen.importers.running_graph.graph_import:read_ros_1_graph",
        ),
        ImportFormat(
            "orca",
            "components of the Orca Robotics project, from their definition files (.def)",
            (),
            "archgen.importers.orca.orca_import:read_orca",
        ),
    )
}


def guess_format(file: Path) -> ImportFormat | None:
    """Return the format whose files end as this one does, or None."""
    name = file.name.lower()
    return next((known for known in IMPORT_FORMATS.values() if name.endswith(known.endings)), None)
