"""The verbs that write: where it goes, what is never overwritten, and that errors stop them unless asked otherwise."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import jsonschema_rs
import pytest
import yaml

from archgen import resources
from archgen.emit.own_file_marks import PACKED_HEADER
from tests.cli.conftest import Run
from tests.running import ROOT


def test_pack(run: Run, first: Path, tmp_path: Path) -> None:
    ran = run("pack", first)
    assert (ran.status, ran.err) == (0, "")
    packed = first / "archgen-out" / "packed.yaml"
    assert packed.read_text(encoding="utf-8").startswith(f"{PACKED_HEADER}archgen: 1\nproject:\n")
    assert run("pack", packed, "-o", tmp_path / "new" / "again.yaml").status == 0
    assert (tmp_path / "new" / "again.yaml").read_bytes() == packed.read_bytes()


def test_pack_resolved(run: Run, first: Path) -> None:
    assert run("pack", "--resolved", first).status == 0
    data = yaml.safe_load((first / "archgen-out" / "resolved.yaml").read_text(encoding="utf-8"))
    schema = json.loads(resources.resource_path("schemas", "resolved.schema.json").read_text(encoding="utf-8"))
    assert list(jsonschema_rs.Draft202012Validator(schema).iter_errors(data)) == []


@pytest.mark.parametrize("verb", ["pack", "report", "site", "diagram", "build"])
def test_errors_stop_what_writes(run: Run, broken: Path, verb: str) -> None:
    ran = run(verb, broken)
    assert (ran.status, ran.out) == (1, "")
    assert ran.err.startswith("error[unknown-reference]")
    assert ran.err.endswith("Nothing was written. With --keep-going outputs are made of what is sound.\n")
    assert [path.name for path in broken.iterdir()] == ["archgen.yaml"]


def test_keep_going(run: Run, broken: Path) -> None:
    ran = run("pack", "--keep-going", broken)
    assert ran.status == 1
    assert (broken / "archgen-out" / "packed.yaml").exists()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("pack", "--select", "lidar"), "--select goes with --resolved: a packed project is whole"),
        (("pack", "--resolved", "--select", "lidr"), "nothing is called `lidr`; did you mean `lidar`?"),
        (("diagram", "--format", "gif"), "--format takes svg, png, pdf, dot, separated by commas, not 'gif'"),
        (("diagram", "--depth", "-1"), "-1 is not in the range x>=0"),
        (("report", "--level", "high"), "'high' is not one of 'functional', 'implementation'"),
        (("report", "--document", "all"), "'all' is not one of 'deliverable', 'data-sheets', 'workbook', 'full'"),
        (
            ("report", "--document", "workbook", "--format", "docx"),
            "`--document workbook` goes with `--format xlsx` alone",
        ),
        (
            ("report", "--document", "data-sheets", "-o", "a.xlsx"),
            "`--document workbook` goes with `--format xlsx` alone",
        ),
        (("report", "--since", "v0"), "v0"),
    ],
)
def test_wrong_usage(run: Run, first: Path, words: tuple[str, ...], said: str) -> None:
    ran = run(*words, first)
    assert (ran.status, ran.out) == (2, "")
    assert said in ran.err
    assert [path.name for path in first.iterdir()] == ["archgen.yaml"]


def test_a_folder_is_no_file_to_write(run: Run, first: Path, tmp_path: Path) -> None:
    ran = run("pack", first, "-o", tmp_path)
    assert ran.status == 2, ran.out
    assert ran.err == f"Error: {tmp_path} is not a regular file; give the name of a file with `-o`\n"


def test_files_of_others_stay(run: Run, first: Path, tmp_path: Path) -> None:
    mine = tmp_path / "mine"
    mine.mkdir()
    (mine / "notes.txt").write_text("keep", encoding="utf-8")
    ran = run("site", first, "-o", mine)
    assert ran.status == 2
    assert "holds files that archgen did not write: `notes.txt`" in ran.err
    assert [path.name for path in mine.iterdir()] == ["notes.txt"]


def test_a_picture_that_there_is_not(run: Run, first: Path, tmp_path: Path) -> None:
    ran = run("diagram", first, "--only", "nothing/*")
    assert ran.status == 2
    assert ran.err.startswith(
        "Error: no picture is called nothing/*; there are overview, overview_upright, components, groups/"
    )
    assert ran.err.endswith(", ...\n")
    (tmp_path / "archgen.yaml").write_text("archgen: 1\n")
    ran = run("diagram", tmp_path, "--only", "overview")
    assert (ran.status, ran.err) == (2, "Error: no picture is called overview; there is nothing to draw yet\n")


def test_pictures_open_composed_components_to_a_depth(run: Run, tmp_path: Path) -> None:
    shutil.copytree(ROOT / "examples" / "cleaning_robot", tmp_path / "robot")
    for words, title in (((), "4 components"), (("--depth", "1"), "Shoulder")):
        assert run("diagram", tmp_path / "robot", "--only", "groups/cleaning", *words).status == 0
        picture = (tmp_path / "robot" / "archgen-out" / "diagrams" / "groups" / "cleaning.svg").read_text("utf-8")
        assert f">{title}</text>" in picture


def test_a_packed_file_does_not_replace_its_project(run: Run, first: Path) -> None:
    before = (first / "archgen.yaml").read_bytes()
    ran = run("pack", first, "-o", first / "archgen.yaml")
    assert ran.status == 2
    assert "archgen.yaml is a file of the project itself" in ran.err
    assert (first / "archgen.yaml").read_bytes() == before
    # What is packed already may be packed in place: nothing changes.
    assert run("pack", first, "-o", first / "packed" / "p.yaml").status == 0
    assert run("pack", first / "packed" / "p.yaml", "-o", first / "packed" / "p.yaml").status == 0


def test_folders_on_the_way_are_made_and_the_file_is_named(run: Run, first: Path) -> None:
    ran = run("pack", first, "-o", first / "new" / "folder" / "x.yaml")
    assert (ran.status, ran.err) == (0, "")
    assert ran.out == f"wrote {first / 'new' / 'folder' / 'x.yaml'}\n"
    assert "\narchgen: 1\n" in (first / "new" / "folder" / "x.yaml").read_text(encoding="utf-8")
