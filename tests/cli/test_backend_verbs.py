"""Backends of a project's own: each verb makes what it is for, and names the right one for the others."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest

from archgen.emit.backend_manifests import find_backends
from tests import repositories
from tests.cli.conftest import Run
from tests.running import ROOT, archgen, archgen_here, contents

PROJECT = """\
archgen: 1
groups: {a: {components: {b: {functionality: Waits., inputs: {x: {external: The world}}}}}}
nodes: {b: {implements: b, subscribes: {x: {topic: x, message: std_msgs/msg/Empty}}}}
"""
SHIPPED = find_backends(ROOT / "docs")[0]
"""The folder has none of its own."""
GENERATORS = [name for name, each in SHIPPED.items() if each.makes == "workspace"]
OF_OTHER_TOOLS = [
    name for name, each in SHIPPED.items() if each.makes == "workspace" or each.views in {("structure",), ("uml",)}
]
"""Generators and models for other tools, which are more and more."""
COMPONENT_FILES = '[{template: t.j2, path: "{{ item.title }}.txt", for_each: graphs, only: {kind: component}}]'
BACKENDS = {
    "pages": "documents",
    "code": "workspace",
    "table": "file",
}


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    """Make a project with a backend for each verb."""
    folder = tmp_path / "robot"
    for name, makes in BACKENDS.items():
        (folder / "backends" / name / "templates").mkdir(parents=True)
        view, files = ("graphs", COMPONENT_FILES) if makes == "workspace" else ("record", "[{template: t.j2, path: t}]")
        (folder / "backends" / name / "backend.yaml").write_text(
            f"{{id: {name}, title: The {name}, emitter: text, makes: {makes}, view: {view}, files: {files}}}"
        )
        (folder / "backends" / name / "templates" / "t.j2").write_text(f"{name}{{{{ ': ä' }}}}\n")
    (folder / "archgen.yaml").write_text(PROJECT)
    return folder


def test_generate_makes_a_workspace(run: Run, robot: Path, tmp_path: Path) -> None:
    ran = run("generate", "code", "-C", robot)
    target = robot / "archgen-out" / "code"
    assert (ran.status, ran.out, ran.err) == (0, f"wrote {target} (1 new)\n", "")
    assert (target / "B.txt").read_text("utf-8") == "code: ä\n"
    assert sorted(contents(target)) == [".archgen/code.json", "B.txt"]
    assert run("generate", "code", "-C", robot, "-o", tmp_path / "new").status == 0
    assert contents(tmp_path / "new") == contents(target)


def test_generate_leaves_files_of_others_alone(run: Run, robot: Path) -> None:
    before = contents(robot)
    ran = run("generate", "code", "-C", robot, "-o", robot)
    assert (ran.status, ran.err) == (0, "")
    after = contents(robot)
    assert {path: after.pop(path) for path in ("B.txt", ".archgen/code.json")}["B.txt"] == "code: ä\n".encode()
    assert after == before


def test_errors_remove_nothing_that_was_generated(run: Run, robot: Path) -> None:
    second = robot / "second.yaml"
    second.write_text("groups: {a: {components: {c: {functionality: Waits.}}}}\n")
    assert run("generate", "code", "-C", robot).status == 0
    made = contents(robot / "archgen-out" / "code")
    assert "C.txt" in made
    second.write_text("groups: {a: {components: {c: {functionality: [\n")
    assert run("generate", "code", "-C", robot, "--keep-going").status == 1
    assert contents(robot / "archgen-out" / "code") == made
    second.unlink()
    assert run("generate", "code", "-C", robot).status == 0
    assert "C.txt" not in contents(robot / "archgen-out" / "code")


def test_export_makes_a_file(robot: Path, tmp_path: Path) -> None:
    for run_verb, words in ((archgen, ()), (archgen_here, ("-o", "-"))):
        done = run_verb("export", "table", *words, cwd=robot)
        assert (done.stdout, done.stderr) == ("table: ä\n".encode(), b"")
    done = archgen_here("export", "table", "-o", tmp_path / "new" / "t.csv", cwd=robot)
    assert done.stdout.decode() == f"wrote {tmp_path / 'new' / 't.csv'}\n"
    assert (tmp_path / "new" / "t.csv").read_text("utf-8") == "table: ä\n"
    assert sorted(contents(tmp_path / "new")) == ["t.csv"]


@pytest.mark.parametrize(
    "name", ["archgen.yaml", "link.yaml", "backends/table/backend.yaml", "backends/table/templates/t.j2"]
)
def test_export_never_replaces_what_the_project_reads(run: Run, robot: Path, name: str) -> None:
    (robot / "link.yaml").symlink_to("archgen.yaml")
    before = contents(robot)
    ran = run("export", "table", "-C", robot, "-o", robot / name)
    assert (ran.status, ran.out) == (2, "")
    assert f"{name} is a file of the project itself; give the name of another file with `-o`" in ran.err
    assert contents(robot) == before


def test_export_into_a_folder(run: Run, robot: Path) -> None:
    ran = run("export", "table", "-C", robot, "-o", robot / "backends")
    assert (ran.status, ran.err) == (
        2,
        f"Error: {robot / 'backends'} is not a regular file; give the name of a file with `-o`\n",
    )


@pytest.mark.parametrize(
    ("words", "error"),
    [
        (
            ("build", "--backend", "code"),
            "the backend `code` makes a workspace, not documents; `archgen generate code`",
        ),
        (("build", "--only", "code"), "the backend `code` makes a workspace, not documents; `archgen generate code`"),
        (
            ("build", "--backend", "table"),
            "the backend `table` makes a single file, not documents; `archgen export table`",
        ),
        (("generate", "wiki"), "the backend `wiki` makes documents, not a workspace; `archgen build --backend wiki`"),
        (("generate", "table"), "the backend `table` makes a single file, not a workspace; `archgen export table`"),
        (
            ("export", "pages"),
            "the backend `pages` makes documents, not a single file; `archgen build --backend pages`",
        ),
        (("export", "code"), "the backend `code` makes a workspace, not a single file; `archgen generate code`"),
    ],
)
def test_each_verb_names_the_right_one_for_others(
    run: Run, robot: Path, monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...], error: str
) -> None:
    monkeypatch.chdir(robot)
    before = contents(robot)
    ran = run(*words)
    assert (ran.status, ran.out, ran.err) == (2, "", f"Error: {error} makes it\n")
    assert contents(robot) == before


@pytest.mark.parametrize(
    ("words", "error"),
    [
        (("generate", "coed"), "there is no text backend `coed`; did you mean `code`?"),
        (
            ("export", "zzz"),
            "there is no text backend `zzz`; there are d2, graphml, mermaid, plantuml, reqif, structurizr, xmi, table",
        ),
        (
            ("export", "report"),
            "there is no text backend `report`; there are d2, graphml, mermaid, plantuml, reqif, structurizr, xmi, table",
        ),
    ],
)
def test_a_name_that_is_no_backend(
    run: Run, robot: Path, monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...], error: str
) -> None:
    monkeypatch.chdir(robot)
    ran = run(*words)
    assert (ran.status, ran.err) == (2, f"Error: {error}\n")


def test_a_name_that_no_backend_of_a_workspace_has(run: Run, first: Path) -> None:
    ran = run("generate", "zzz", "-C", first, "-o", first.parent / "workspace")
    assert ran.err == f"Error: there is no text backend `zzz`; there are {', '.join(GENERATORS)}\n"


def test_a_backend_cannot_be_called_as_an_output(run: Run, robot: Path, tmp_path: Path) -> None:
    folder = (robot / "backends" / "pages").rename(robot / "backends" / "diagrams")
    manifest = (folder / "backend.yaml").read_text().replace("id: pages", "id: diagrams")
    (folder / "backend.yaml").write_text(manifest)
    ran = run("build", robot, "-o", tmp_path / "out", "--backend", "diagrams")
    assert ran.status == 2
    assert "the backend `diagrams` is called as an output of archgen itself" in ran.err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("verb", [("generate", "code"), pytest.param(("export", "table"), marks=pytest.mark.slow)])
def test_backends_of_a_branch_run_only_if_the_main_line_names_them(robot: Path, verb: tuple[str, str]) -> None:
    repositories.repository(robot, {"archgen.yaml": PROJECT})
    done = archgen_here(*verb, "--trust", "main", "-o", "out", cwd=robot, status=2)
    assert f"the project's own backend `{verb[1]}` is not run here".encode() in done.stderr
    assert not (robot / "out").exists()
    repositories.commit(robot, {"archgen.yaml": f"{PROJECT}review: {{backends: [{verb[1]}]}}\n"})
    archgen_here(*verb, "--trust", "main", "-o", "out", cwd=robot)
    assert (robot / "out").exists()


@pytest.mark.parametrize("verb", [("generate", "code"), ("export", "table")])
def test_errors_stop_them_unless_asked_otherwise(run: Run, robot: Path, verb: tuple[str, str]) -> None:
    (robot / "archgen.yaml").write_text(PROJECT.replace("implements: b", "implements: c"))
    ran = run(*verb, "-C", robot, "-o", robot / "out")
    assert (ran.status, ran.out) == (1, "")
    assert ran.err.endswith("Nothing was written. With --keep-going outputs are made of what is sound.\n")
    assert not (robot / "out").exists()
    assert run(*verb, "-C", robot, "-o", robot / "out", "--keep-going").status == 1
    assert (robot / "out").exists()


def test_a_template_that_fails_leaves_the_file_as_it_was(run: Run, robot: Path, tmp_path: Path) -> None:
    target = tmp_path / "t"
    assert run("export", "table", "-C", robot, "-o", target).status == 0
    (robot / "backends" / "table" / "templates" / "t.j2").write_text("one\n{{ nobody }}")
    ran = run("export", "table", "-C", robot, "-o", target)
    assert (ran.status, ran.err) == (
        2,
        "Error: backends/table/templates/t.j2:2:1: the backend `table` fails: 'nobody' is undefined\n",
    )
    assert target.read_text("utf-8") == "table: ä\n"


TABLE = """\
id              title                      makes      emitter  view                      origin
report          Word report                documents  docx     outline                   shipped
reqif           Requirements as ReqIF      file       reqif    record                    shipped
site            Static site                documents  site     pages                     shipped
wiki            Wiki pages                 documents  text     pages, graphs, sequences  shipped
code            The code                   workspace  text     graphs                    own
pages           The pages                  documents  text     record                    own
table           The table                  file       text     record                    own
"""


def test_backends_are_listed(run: Run, robot: Path) -> None:
    lines = run("list", "--of", "backends", "-C", robot).out.splitlines()
    # The columns are as wide as the words of all backends.
    shown_rows = [line.split() for line in lines if line.split()[0] not in OF_OTHER_TOOLS]
    assert shown_rows == [line.split() for line in TABLE.splitlines()]
    assert len({line.rindex("  ") for line in lines[1:]}) == 1
    assert {line.split()[0] for line in lines} >= set(OF_OTHER_TOOLS)
    rows = json.loads(run("list", "--of", "backends", "--format", "json", "-C", robot).out)
    assert rows[-1] == {
        "id": "table",
        "title": "The table",
        "makes": "file",
        "emitter": "text",
        "view": "record",
        "origin": "own",
    }
    table = list(csv.reader(run("list", "--of", "backends", "--format", "csv", "-C", robot).out.splitlines()))
    assert [line.split() for line in TABLE.splitlines() if "  own" in line] == [
        " ".join(row).split() for row in table if row[-1] == "own"
    ]


def test_a_manifest_that_cannot_be_read_is_named_and_not_listed(run: Run, robot: Path) -> None:
    (robot / "backends" / "code" / "backend.yaml").write_text("id: code\ntitle: \x1b[31m\n")
    ran = run("list", "--of", "backends", "-C", robot)
    assert ran.status == 0
    assert ran.err.startswith("warning: backends/code/backend.yaml:1:1: ")
    assert "\x1b" not in ran.err
    assert "code" not in ran.out


def test_a_selector_does_not_go_with_backends(run: Run, robot: Path) -> None:
    ran = run("list", "--of", "backends", "-C", robot, "b")
    assert ran.status == 2
    assert ran.err.endswith("Error: a selector names elements: `--of backends` takes none\n")


@pytest.mark.parametrize(
    ("words", "names"),
    [
        ("generate c", ["code"]),
        ("export ", ["d2", "graphml", "mermaid", "plantuml", "reqif", "structurizr", "xmi", "table"]),
        ("build --backend p", ["pages"]),
        ("build --only report,p", ["report,packed", "report,pages"]),
    ],
)
def test_names_are_completed(robot: Path, words: str, names: list[str]) -> None:
    *done_words, last_word = f"archgen {words}".split(" ")
    environment = {
        "_ARCHGEN_COMPLETE": "bash_complete",
        "COMP_WORDS": " ".join((*done_words, last_word)),
        "COMP_CWORD": str(len(done_words)),
    }
    done = archgen_here(cwd=robot, env=environment)
    assert [line.partition(",")[2] for line in done.stdout.decode().splitlines()] == names
