"""`archgen import` of models: new projects, slices in projects, updates that keep what people wrote, refusals."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from archgen import installed_plugins
from archgen.diagnostics.source_span import Span
from archgen.edit import imported_slices
from archgen.importers.foreign_import import ForeignFileError, ForeignImport, ImportNote
from tests.cli.conftest import Run


def read_toy(files: Sequence[Path]) -> ForeignImport:
    """Read a format of JSON lists: names of components, `!` before what is not taken."""
    try:
        names = json.loads(files[0].read_text())
    except ValueError:
        words = "this is no toy"
        raise ForeignFileError(words, Span(files[0].name, 3, 4, 3, 5), "play with another") from None
    notes = [
        ImportNote("toy:Thing", f"`{name[1:]}` is no component", Span(files[0].name, 1, 2, 1, 3), "rename it")
        for name in names
        if name.startswith("!")
    ]
    taken = {name: body for name, _, body in (name.partition("=") for name in names if not name.startswith("!"))}
    components = {
        name: {"functionality": body or "Does something.", "outputs": {"data": "Data"}} for name, body in taken.items()
    }
    slices: dict[str, Any] = (
        {"toys.yaml": {"groups": {"toys": {"title": "Toys", "components": components}}}} if taken else {}
    )
    return ForeignImport(slices, {"toy:Component": len(taken)}, tuple(notes), title="Toy robot", distro="jazzy")


@pytest.fixture(autouse=True)
def toy_format(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    facts = {"rank": 99, "summary": "a toy", "endings": (".toy",), "reader": f"{__name__}:read_toy"}
    wishes = {"rank": 98, "summary": "wishes", "endings": (".wish",), "reader": "none:none", "has_requirements": True}
    plugins = {"toys": {"api": 1, "importers": {"toy": facts, "wishes": wishes}}}
    monkeypatch.setattr(installed_plugins, "list_shipped_plugins", lambda: plugins)
    monkeypatch.chdir(tmp_path)


def write_model(*names: str) -> str:
    Path("robot.toy").write_text(json.dumps(names))
    return "robot.toy"


def test_a_model_becomes_a_project(run: Run) -> None:
    done = run("import", write_model("arm", "!soul"), "-o", "robot")
    assert done.status == 0
    out = done.out
    assert (
        "taken: 1 toy:Component\n  not taken: robot.toy:1:2: toy:Thing: `soul` is no component\n    = help: rename it"
        in out
    )
    assert Path("robot/toys.yaml").read_text().startswith("# From robot.toy by `archgen import toy`; with --merge")
    assert "title: Toy robot" in Path("robot/archgen.yaml").read_text()
    done = run("check", "robot")
    assert done.status == 0


def test_slices_go_into_the_project_around(run: Run) -> None:
    Path("archgen.yaml").write_text("project: {title: Mine}\nsources: [own.yaml]\n")
    Path("own.yaml").write_text("groups: {}\n")
    done = run("import", "toy", write_model("arm"))
    assert done.status == 0
    assert "the project does not read toys.yaml yet: add it to `sources`" in done.err
    assert Path("archgen.yaml").read_text() == "project: {title: Mine}\nsources: [own.yaml]\n"


def test_a_second_import_overwrites_nothing_and_an_update_keeps_what_people_wrote(
    run: Run,
) -> None:
    done = run("import", write_model("arm", "leg"), "-o", "robot")
    assert done.status == 0
    path = Path("robot/toys.yaml")
    text = path.read_text().replace("Does something.", "Was changed.  # by hand", 1)
    path.write_text(
        text.replace("      leg:\n", "      leg:\n        owner: us  # since May\n") + "partners: {us: {title: We}}\n"
    )
    edited = path.read_text()
    done = run("import", write_model("arm=Lifts.", "leg", "head"), "-o", "robot")
    assert done.status == 2
    assert "toys.yaml is there already; nothing was written; `--merge` brings it up to date" in done.err
    assert path.read_text() == edited
    done = run("import", write_model("arm=Lifts.", "head"), "-o", "robot", "--merge")
    assert (done.status, "no file declares the component `toys.leg`" in done.err) == (1, True)
    leg = "groups.toys.components.leg"
    assert f"  not said any more, but people wrote there, which stays: {leg} (toys" in done.out
    conflict = "groups.toys.components.arm.functionality: it was `Does something.` and is `Lifts.` now"
    assert f"  conflict: {conflict}; `Was changed.` of the slice stays" in done.out
    updated = path.read_text()
    assert "functionality: Was changed.  # by hand" in updated
    assert "owner: us  # since May" in updated
    assert "head:" in updated
    assert "partners: {us: {title: We}}" in updated
    done = run("import", "robot.toy", "-o", "robot", "--merge")
    assert "as before" in done.out
    assert path.read_text() == updated


def test_an_update_leaves_files_of_others_alone(run: Run) -> None:
    Path("archgen.yaml").write_text("project: {title: Mine}\n")
    Path("toys.yaml").write_text("groups: {}\n")
    done = run("import", write_model("arm"), "--merge")
    assert done.status == 2
    assert "toys.yaml does not come from this file: nothing was written" in done.err
    assert Path("toys.yaml").read_text() == "groups: {}\n"


def test_json_lists_what_was_taken_and_a_dry_run_writes_nothing(run: Run) -> None:
    done = run("import", write_model("arm", "!soul"), "-o", "robot", "--dry-run", "--format", "json")
    assert done.status == 0
    record = json.loads(done.out)
    assert record["taken"] == {"toy:Component": 1}
    assert [(note["kind"], note["line"], note["column"]) for note in record["notes"]] == [("toy:Thing", 1, 2)]
    assert [file["file"] for file in record["files"]] == ["archgen.yaml", "toys.yaml"]
    assert not Path("robot").exists()


def test_errors_that_come_with_a_model_are_shown(run: Run) -> None:
    Path("archgen.yaml").write_text("project: {title: Mine}\n")
    # A component that the model names is an instance here, and may not say what its type says.
    Path("own.yaml").write_text("component_types: {toy: {}}\ngroups: {toys: {components: {arm: {same_as: toy}}}}\n")
    done = run("import", write_model("arm"))
    assert done.status == 1
    err = done.err
    assert "these errors are in what the model says" in err


def test_what_another_file_says_is_not_written_again(run: Run) -> None:
    Path("archgen.yaml").write_text("project: {title: Mine}\n")
    Path("own.yaml").write_text("groups: {toys: {title: Other, components: {arm: {functionality: Mine.}}}}\n")
    done = run("import", write_model("arm"))
    assert done.status == 0
    assert "said otherwise by another file, which stays as it is: groups.toys.title: `Other` in own.yaml" in done.out


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("none.toy",), "there is no file none.toy"),
        (("toi", "robot.toy"), "there is no file and no format `toi`; did you mean `toy`?"),
        (("notes.txt",), "its name does not tell the format of notes.txt: name it first, one of "),
        (("robot.toy", "--into", "x.yaml"), "--into does not go with toy"),
        (("robot.toy",), "there is no project here: `-o FOLDER` makes a new one of the model"),
        (("wishes", "notes.txt", "-o", "x"), "--output does not go with wishes"),
        (("robot.toy", "rate:=3", "-o", "x"), "toy takes no arguments such as rate:=..., as launch files do"),
        (("launch", "rate:=3", "-o", "x"), "there is no file launch"),
        (("rate:=3", "-o", "x"), "name a file, too"),
        (("robot.toy", f"rate:={'3' * 300}", "-o", "x"), "toy takes no arguments such as rate:="),
        (("x" * 300,), "there is no file xxx"),
    ],
)
def test_wrong_words_are_told(words: tuple[str, ...], message: str, run: Run) -> None:
    write_model("arm")
    Path("notes.txt").write_text("x")
    done = run("import", *words)
    assert done.status == 2
    assert message in done.err


def test_a_file_that_is_none_and_one_with_nothing_in_it(run: Run) -> None:
    Path("broken.toy").write_text("{")
    done = run("import", "broken.toy", "-o", "robot")
    assert done.status == 1
    assert "error: broken.toy:3:4: this is no toy\n  = help: play with another" in done.err
    done = run("import", write_model("!soul"), "-o", "robot")
    assert done.status == 1
    assert "there is nothing in it that archgen takes" in done.err
    assert not Path("robot").exists()


def test_what_archgen_could_not_read_is_not_written(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(imported_slices, "MAX_BYTES", 1 << 20)
    done = run("import", write_model(f"arm={'x' * (1 << 20)}"), "-o", "robot")
    assert done.status == 2
    assert "toys.yaml would be larger than 1 MiB, more than archgen reads: import the model in parts" in done.err
    assert not Path("robot").exists()
