"""Definition files of Orca become component types that `archgen generate orca` calls by the same tags."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.importers.foreign_import import ForeignFileError, ForeignImport
from archgen.pipeline import check_project
from archgen.plugins.orca.orca_import import read_orca
from archgen.products.output_options import OutputOptions
from archgen.products.workspace_product import WorkspaceRequest, write_workspace
from archgen.syntax.yaml_writer import write_yaml

DEFINITION = """\
DefaultComponentTag=FaithLocaliser3d
DefaultComponentEndpoints=udp
Component.Comment.1=Believes the wheels.

# Provided Interfaces
Provides.Localise3d.Type=::orca::Localise3d
Provides.Localise3d.DefaultName=localise3d
Provides.Status.Type=Status
Provides.Status.DefaultInterface=state of it

# Required Interfaces
Requires.Odometry3d.Type=Odometry3d
Requires.Odometry3d.DefaultProxy=odometry3d0@local/logplayer

Config.StdDevPosition.Comment=Std deviation \\# of the position   # in metres
Config.StdDevPosition.Default=0.05
Config.StartAngle.Type=angle
Config.StartAngle.Default=-90
Config.SickAcfr.Device.Default=/dev/ttyS0
Config.USB.Port.Type=string
Config.USB.Port.Default=1
Config.Name.Type=colour
Config.Name.Default=
ExternalConfig.Ice.MessageSizeMax.Default=3000
Confg.Slip=1
"""
EXPECTED = {
    "description": "Believes the wheels.",
    "inputs": {
        "odometry3d": {
            "type": "Odometry3d",
            "description": "By default it is connected to `odometry3d0@local/logplayer`.",
        }
    },
    "outputs": {"localise3d": "Localise3d", "state_of_it": {"type": "Status", "hints": {"orca": {"tag": "Status"}}}},
    "parameters": {
        "std_dev_position": {"value": 0.05, "description": "Std deviation # of the position"},
        "start_angle": {"type": "float", "value": -90.0},
        "sick_acfr.device": "/dev/ttyS0",
        "usb.port": {"type": "string", "value": "1"},
        "name": "",
        "Ice.MessageSizeMax": 3000,
    },
    "hints": {"orca": {"tag": "FaithLocaliser3d", "endpoints": "udp", "untagged": ["Ice"]}},
}


def read_definition(folder: Path, text: str = DEFINITION) -> ForeignImport:
    """Read one definition."""
    path = folder / "faithlocaliser3d.def"
    path.write_text(text, encoding="utf-8")
    return read_orca([path])


def test_a_definition_becomes_a_component_type(tmp_path: Path) -> None:
    imported = read_definition(tmp_path)
    assert imported.slices == {"orca_types.yaml": {"component_types": {"faithlocaliser3d": EXPECTED}}}
    assert imported.taken == {"Config": 5, "ExternalConfig": 1, "Provides": 2, "Requires": 1, "component": 1}
    assert [f"{note.fate}: {note.span.line}: {note.message}" for note in imported.notes] == [
        "noted: 8: `state of it` is called `state_of_it`",
        "noted: 21: the set of `USB.Port` is called `usb`",
        "not taken: 22: `colour` is no type of Orca",
        "not taken: 25: `Confg.Slip` is no key of a definition",
    ]


def test_the_backend_writes_the_same_tags(tmp_path: Path) -> None:
    imported = read_definition(tmp_path)
    project = tmp_path / "project"
    project.mkdir()
    for name, sections in imported.slices.items():
        (project / name).write_text(write_yaml(sections))
    (project / "archgen.yaml").write_text(
        "archgen: 1\nproject: {id: car}\ngroups: {g: {components: {loc: {is: faithlocaliser3d}}}}\nhosts: {pc: {}}\n"
        "nodes: {loc: {implements: loc, kind: program, host: pc, command: [faithlocaliser3d]}}\n"
    )
    checked = check_project(project)
    assert not checked.has_errors
    write_workspace(checked, OutputOptions(), "orca", tmp_path / "ws", WorkspaceRequest())
    (config,) = (tmp_path / "ws").rglob("*.cfg")
    lines = config.read_text().splitlines()
    for line in (
        "FaithLocaliser3d.Endpoints=udp",
        "FaithLocaliser3d.Provides.Localise3d.Name=localise3d",
        "FaithLocaliser3d.Provides.Status.Name=state_of_it",
        "FaithLocaliser3d.Config.StdDevPosition=0.05",
        "FaithLocaliser3d.Config.StartAngle=-90.0",
        "FaithLocaliser3d.Config.SickAcfr.Device=/dev/ttyS0",
        "Ice.MessageSizeMax=3000",
    ):
        assert line in lines


def test_a_folder_stands_for_its_definitions(tmp_path: Path) -> None:
    (tmp_path / "inner").mkdir()
    read_definition(tmp_path / "inner")
    assert list(read_orca([tmp_path]).slices["orca_types.yaml"]["component_types"]) == ["faithlocaliser3d"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "it has no `DefaultComponentTag`"),
        ("int main() { return 0; }\n", "it has no `DefaultComponentTag`"),
        ("DefaultComponentTag=\n", "it has no `DefaultComponentTag`"),
        ("a\0b", "it is no text"),
    ],
)
def test_what_is_no_definition_is_told(text: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(ForeignFileError) as caught:
        read_definition(tmp_path, text)
    assert caught.value.message == message


def test_a_folder_without_definitions_is_told(tmp_path: Path) -> None:
    with pytest.raises(ForeignFileError):
        read_orca([tmp_path])


def test_links_are_not_followed_and_lines_are_counted_by_their_ends(tmp_path: Path) -> None:
    outside = tmp_path / "outside.def"
    outside.write_text("DefaultComponentTag=Secret\n")
    folder = tmp_path / "components"
    folder.mkdir()
    (folder / "link.def").symlink_to(outside)
    (folder / "own.def").write_bytes(b"# a\x0cb\r\nDefaultComponentTag=Own\r\nStrange=1\r\n")
    imported = read_orca([folder])
    assert list(imported.slices["orca_types.yaml"]["component_types"]) == ["own"]
    assert [note.span.line for note in imported.notes] == [3]
