"""The backend `orca`: configurations in the paper's form, that Ice reads back as the model has them."""

from __future__ import annotations

import os
import re
import shutil
from pathlib import Path

import pytest

from tests.cli.conftest import Run, run
from tests.plugins.orca.ice_properties import read_properties
from tests.running import ROOT

__all__ = ["run"]
VEHICLE = ROOT / "examples" / "vehicle"
SCENARIO = {"car", "dgclocalnav", "faithlocaliser3d", "gridmap", "highlevelplanner", "imu", "laser2d0", "orcaview2d"}


def generate(run: Run, project: Path, workspace: Path, *arguments: str) -> None:
    ran = run("generate", "orca", "-C", project, "-o", workspace, *arguments)
    assert (ran.status, ran.err) == (0, "")


def write_project(folder: Path, components: str, more: str = "") -> Path:
    path = folder / "archgen.yaml"
    path.write_text(
        f"archgen: 1\nproject: {{id: lab}}\nrules: {{missing-detail: off}}\n{more}\ngroups: {{g: {{components: {{\n{components}}}}}}}\n",
        "utf-8",
    )
    return path


def read_files(workspace: Path) -> dict[str, str]:
    return {path.stem: path.read_text("utf-8") for path in sorted((workspace / "cfg").glob("*"))}


def test_a_file_is_as_the_paper_shows_it(run: Run, tmp_path: Path) -> None:
    project = write_project(
        tmp_path,
        """\
  c1: {
    functionality: F, inputs: {near: other.i3, far: other.i2}, outputs: {i1: T, i2: T}, node: {host: p1},
    parameters: {set_tag1: {param_tag1: 0.1, set_tag2: {param_tag2: 1}}},
    hints: {orca: {tag: COMP_TAG, endpoints: e1}}},
  other: {functionality: F, inputs: {}, outputs: {i2: T, i3: {type: T, hints: {orca: {endpoint: tcp -h arm -p 9000}}}}, node: {host: p2}}
""",
        "types: {T: }\nhosts: {p1: {}, p2: {}}",
    )
    ran = run("generate", "orca", "-C", project, "-o", tmp_path / "ws", "--keep-going")
    assert ran.status == 0, ran.err
    assert (
        read_files(tmp_path / "ws")["c1"]
        == """\
# Made by archgen from g.c1.

# Component
COMP_TAG.Platform=p1
COMP_TAG.Component=c1
COMP_TAG.Endpoints=e1

# Provided interfaces
COMP_TAG.Provides.I1.Name=i1
COMP_TAG.Provides.I2.Name=i2

# Required interfaces
# Direct binding
COMP_TAG.Requires.Near.Proxy=i3:tcp -h arm -p 9000
# Indirect binding
COMP_TAG.Requires.Far.Proxy=i2@p2/other

# Configuration Options
COMP_TAG.Config.SetTag1.ParamTag1=0.1
COMP_TAG.Config.SetTag1.SetTag2.ParamTag2=1
"""
    )
    assert "Other.Endpoints=tcp -h arm -p 9000\n" in read_files(tmp_path / "ws")["other"]


def test_the_scenario_of_the_paper(run: Run, tmp_path: Path) -> None:
    generate(run, VEHICLE / "scenario", tmp_path)
    files = read_files(tmp_path)
    assert set(files) == SCENARIO
    navigation = read_properties(files["dgclocalnav"])
    assert navigation["Dgclocalnav.Requires.Scan.Proxy"] == "scan@desk_pc/laser2d0"
    assert navigation["Dgclocalnav.Config.SafetyDistance.Driving"] == "1.5"
    assert navigation["Dgclocalnav.Config.TestInSimulationMode"] == "0"
    assert read_properties(files["gridmap"])["Gridmap.Config.MapFile"] == "maps/parking_lot.pnm.gz"
    # What is physical is no interface.
    assert not any("Requires" in text for text in (files["imu"], files["laser2d0"]))


def test_two_instances_have_two_files_and_one_program(run: Run, tmp_path: Path) -> None:
    generate(run, VEHICLE / "two_lasers", tmp_path)
    front, rear = (read_files(tmp_path)[name] for name in ("laser2d0", "laser2d1"))
    assert front.splitlines()[1] == rear.splitlines()[1] == "# Program: laser2d of orca_laser2d"
    first, second = read_properties(front), read_properties(rear)
    assert set(first) == set(second)
    assert {key for key in first if first[key] != second[key]} == {
        "Laser2d.Component",
        "Laser2d.Config.Frame",
        "Laser2d.Config.Offset.Position.X",
        "Laser2d.Config.Offset.Rotation.Yaw",
        "Laser2d.Config.PlayerClient.Device",
    }


def test_the_second_experiment_touches_only_what_differs(run: Run, tmp_path: Path) -> None:
    # Without git a project reads nothing outside of its own folder: the library moves into it.
    shutil.copytree(VEHICLE / "scenario", tmp_path / "scenario")
    shutil.copytree(VEHICLE / "library", tmp_path / "scenario" / "library")
    experiment = tmp_path / "scenario" / "archgen.yaml"
    experiment.write_text(experiment.read_text("utf-8").replace("../library", "library"), "utf-8")
    workspace = tmp_path / "ws"
    generate(run, tmp_path / "scenario", workspace, "--option", "platform=vehicle")
    before = {path.stem: path.stat() for path in (workspace / "cfg").iterdir()}
    text = experiment.read_text("utf-8").replace("max_forward_speed: 3.0", "max_forward_speed: 2.5")
    experiment.write_text(f"# A line more\n{text}", "utf-8")
    generate(run, tmp_path / "scenario", workspace, "--option", "platform=vehicle")
    assert _list_touched(workspace, before) == {"car"}
    # The scanner in front and the planner's program are those of the first experiment.
    shutil.copytree(workspace, tmp_path / "second")
    before = {path.stem: path.stat() for path in (tmp_path / "second" / "cfg").iterdir()}
    generate(run, VEHICLE / "two_lasers", tmp_path / "second", "--option", "platform=vehicle")
    touched = _list_touched(tmp_path / "second", before)
    assert SCENARIO - touched == {"faithlocaliser3d", "imu", "laser2d0"}


def _list_touched(workspace: Path, before: dict[str, os.stat_result]) -> set[str]:
    def stamp(stat: os.stat_result) -> tuple[int, ...]:
        return stat.st_ino, stat.st_mtime_ns, stat.st_size

    after = {path.stem: path.stat() for path in (workspace / "cfg").iterdir()}
    return {name for name, stat in after.items() if name not in before or stamp(before[name]) != stamp(stat)}


def test_two_providers_are_refused_with_both_places(run: Run, tmp_path: Path) -> None:
    project = write_project(
        tmp_path,
        """\
  a: {functionality: F, inputs: {}, outputs: {o: T}},
  b: {functionality: F, inputs: {}, outputs: {o: T}},
  c: {functionality: F, outputs: {}, inputs: {i: {from: [
    a.o,
    b.o]}}}
""",
        "types: {T: }",
    )
    ran = run("generate", "orca", "-C", project, "-o", tmp_path / "ws", "--keep-going")
    assert ran.status != 0
    assert "unmet-need" in ran.err
    assert "`g.c.i` has 2 sources, `g.a.o` and `g.b.o`" in ran.err
    places = re.findall(r"--> (archgen.yaml:\S+)", ran.err)
    assert places == ["archgen.yaml:9:5", "archgen.yaml:10:5"]
    assert not (tmp_path / "ws" / "cfg").exists()


@pytest.mark.parametrize(
    ("components", "words"),
    [
        ('a: {functionality: F, parameters: {p: "x\\nEvil=1"}}', "the value of `p` of `g.a` has a line break"),
        ('a: {functionality: F, parameters: {p: "x\\x85y"}}', "the value of `p` of `g.a` has a line break"),
        ('a: {functionality: F, parameters: {p: [ok, "x\\u2028y"]}}', "the value of `p` of `g.a` has a line break"),
        ("a: {functionality: F, parameters: {p: ['x\"y']}}", "has a double quote in a list"),
        ("a: {functionality: F, parameters: {p: $(find x)}}", "is filled in by a launch file"),
        ('a: {functionality: F, hints: {orca: {tag: "A\\nB=1"}}}', "the tag of `g.a` is no word"),
        ("a: {functionality: F, parameters: {max_x: 1, maxX: 2}}", "`g.a max_x` and `g.a maxX` have the same tag `MaxX`"),
        (
            "a: {functionality: F, outputs: {o: {type: T, hints: {orca: {tag: P}}}, p: T}}",
            "`g.a.o` and `g.a.p` have the same tag `P`",
        ),
    ],
)  # fmt: skip
def test_what_no_line_holds_is_refused(run: Run, tmp_path: Path, components: str, words: str) -> None:
    project = write_project(tmp_path, components, "types: {T: }")
    ran = run("generate", "orca", "-C", project, "-o", tmp_path / "ws", "--keep-going")
    assert ran.status != 0
    assert words in ran.err
    assert "archgen.yaml:6:" in ran.err
    assert not (tmp_path / "ws" / "cfg").exists()


TEXTS = [
    "a=b",
    "a # b",
    " ends ",
    "c:\\d\\\\",
    "\\",
    "#",
    "=",
    "tail\\",
    "x \\# y",
    "\\ ",
    "{{ 7 }}",
    "ä ☃",
    "$HOME `id`",
    "-- */",
]


def test_ice_reads_every_text_back(run: Run, tmp_path: Path) -> None:
    values = ", ".join(f"p{number}: '{text}'" for number, text in enumerate(TEXTS))
    project = write_project(tmp_path, f"a: {{functionality: F, parameters: {{{values}}}}}")
    ran = run("generate", "orca", "-C", project, "-o", tmp_path / "ws", "--keep-going")
    assert ran.status == 0, ran.err
    properties = read_properties(read_files(tmp_path / "ws")["a"])
    assert [properties[f"A.Config.P{number}"] for number in range(len(TEXTS))] == TEXTS


def test_what_hints_say_stays_in_its_line(run: Run, tmp_path: Path) -> None:
    project = write_project(
        tmp_path,
        'a: {functionality: F, outputs: {o: {type: T, hints: {orca: {endpoint: "tcp -h x\\nEvil=1"}}}}, hints: {orca: {untagged: [Ice]}},\n'
        '    parameters: {Ice: {Thread: {Size: 4}, List: [a b, 1, true], "K\\nEvil": 1}, given: {type: string}}},\n'
        'b: {functionality: F, inputs: {i: a.o, j: {type: T, external: x, hints: {orca: {proxy: "p\\u2028Evil=1 # x"}}}, k: {type: T, optional: true}}}',
        "types: {T: }",
    )
    ran = run("generate", "orca", "-C", project, "-o", tmp_path / "ws", "--keep-going")
    assert ran.status in {0, 1}, ran.err
    files = read_files(tmp_path / "ws")
    assert not any(line.startswith("Evil") for text in files.values() for line in text.splitlines())
    first, second = read_properties(files["a"]), read_properties(files["b"])
    assert first["A.Endpoints"] == "tcp -h x Evil=1"
    assert second["B.Requires.J.Proxy"] == "p Evil=1 # x"
    assert first["Ice.Thread.Size"] == "4"
    assert first["Ice.List"] == '"a b" 1 1'
    assert "# A.Config.Given=\n" in files["a"]
    assert "# B.Requires.K.Proxy=\n" in files["b"]


def test_the_example_of_the_page(run: Run, tmp_path: Path) -> None:
    page = (ROOT / "docs" / "middlewares.md").read_text("utf-8")
    (example,) = re.findall(r"```yaml\n(component_types:.*?)```", page, re.DOTALL)
    project = write_project(tmp_path, "front: {is: laser2d}", f"types: {{Scan: }}\n{example}")
    ran = run("generate", "orca", "-C", project, "-o", tmp_path / "ws", "--keep-going")
    assert ran.status == 0, ran.err
    assert read_properties(read_files(tmp_path / "ws")["front"]) == {
        "Laser2d.Platform": "local",
        "Laser2d.Component": "front",
        "Laser2d.Endpoints": "tcp -h 10.0.0.2 -p 9000",
        "Laser2d.Provides.Laser.Name": "scan",
        "Laser2d.Config.MaxRange": "80.0",
        "Ice.MessageSizeMax": "2048",
    }


def test_a_slip_in_hints_is_found_by_check(run: Run, tmp_path: Path) -> None:
    write_project(tmp_path, "a: {functionality: F, hints: {orca: {tags: A}}}")
    ran = run("check", tmp_path)
    assert "`hints.orca.tags` of the component `g.a` is no key that the backend reads" in ran.out + ran.err
