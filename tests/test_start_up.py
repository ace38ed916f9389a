"""Start-up time is a feature: a verb imports what it needs, and nothing that is slow to import without need."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from tests.running import RAMCIP, ROOT

HEAVY = {
    "asyncio",
    "docx",
    "http",
    "jinja2",
    "lxml",
    "markdown_it",
    "networkx",
    "numpy",
    "pygraphviz",
    "rapidfuzz",
    "ruamel",
    "xml.dom",
}
LISTING = """
import json, sys
from archgen.__main__ import main
try:
    main()
except SystemExit:
    pass
with open({file!r}, "w") as file:
    json.dump(sorted(sys.modules), file)
"""


SMALL_PROJECT = "archgen: 1\ngroups: {g: {components: {a: {outputs: {o: std_msgs/msg/Bool}}, b: {inputs: {i: a.o}}}}}\n"
PROTOCOL = {"pygls", "lsprotocol", "cattrs", "mcp", "pydantic"}


def imported_modules(folder: Path, *words: str) -> set[str]:
    """Run a verb with a cache of its own, so that nothing is taken from an earlier run; list what it imported."""
    file = folder / "modules.json"
    code = LISTING.format(file=str(file))
    environment = {"PYTHONPATH": str(ROOT), "XDG_CACHE_HOME": str(folder / "cache"), "PATH": "/usr/bin:/bin"}
    ran = subprocess.run([sys.executable, "-c", code, *words], cwd=folder, env=environment, capture_output=True)  # noqa: S603, PLW1510
    assert b"Traceback" not in ran.stderr
    return set(json.loads(file.read_text(encoding="utf-8")))


def test_the_package_alone_imports_nothing_heavy() -> None:
    code = "import sys, archgen; print(*sorted(sys.modules), sep='\\n')"
    ran = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, check=True)  # noqa: S603
    assert HEAVY & set(ran.stdout.decode().split()) == set()


@pytest.mark.parametrize(
    "words",
    [("--help",), ("--version",), ("check", "--help"), ("stats", str(RAMCIP))],
    ids=" ".join,
)
def test_a_verb_imports_nothing_heavy_without_need(tmp_path: Path, words: tuple[str, ...]) -> None:
    assert HEAVY & imported_modules(tmp_path, *words) == set()


@pytest.mark.parametrize(
    "words", [("show", "g.a"), ("fmt",), ("rename", "a", "c", "--dry-run"), ("lsp", "--help"), ("mcp", "--help")]
)
def test_only_the_language_server_knows_its_protocol(tmp_path: Path, words: tuple[str, ...]) -> None:
    (tmp_path / "archgen.yaml").write_text(SMALL_PROJECT, encoding="utf-8")
    assert PROTOCOL & imported_modules(tmp_path, *words) == set()


def test_a_build_needs_neither_ruamel_nor_networkx_and_a_second_one_no_views(tmp_path: Path) -> None:
    project = tmp_path / "robot"
    project.mkdir()
    (project / "archgen.yaml").write_text(SMALL_PROJECT, encoding="utf-8")
    words = ("build", "robot", "-o", "out")
    modules = imported_modules(tmp_path, *words)
    assert (tmp_path / "out/site/components/g.a.html").exists()
    assert (tmp_path / "out/report.docx").exists()
    assert ({"networkx", "ruamel.yaml"} | PROTOCOL) & modules == set()
    assert "archgen.views.pages.site_pages" in modules
    modules = imported_modules(tmp_path, *words)
    rooms = ("archgen.bringup", "archgen.emit.docx", "archgen.emit.graphviz", "archgen.emit.site", "archgen.simulation")
    views = {name for name in modules if name.startswith("archgen.views.")}
    assert [name for name in sorted(modules) if name.startswith(rooms)] == []
    assert views <= {"archgen.views.picture_shapes"}


def test_the_baseline_is_written_without_ruamel(tmp_path: Path) -> None:
    modules = imported_modules(tmp_path, "check", str(RAMCIP), "--baseline", "b.yaml", "--update-baseline")
    assert (tmp_path / "b.yaml").exists()
    assert HEAVY & modules == set()


def test_a_new_project_is_written_by_ruamel(tmp_path: Path) -> None:
    (tmp_path / "t.csv").write_text("Group,Component\narm,grip\n", encoding="utf-8")
    assert "ruamel.yaml" in imported_modules(tmp_path, "init", "robot", "--from", "t.csv", "--yes")


def test_a_site_that_is_compared_with_nothing_imports_no_comparison(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(SMALL_PROJECT, encoding="utf-8")
    modules = imported_modules(tmp_path, "site", "archgen.yaml", "-o", "out")
    assert (tmp_path / "out/index.html").exists()
    rooms = ("archgen.compare", "archgen.views.changes", "archgen.timing.search")
    assert [name for name in modules if name.startswith(rooms)] == []


def test_what_git_calls_for_each_file_that_it_merges_imports_no_comparison_of_projects(tmp_path: Path) -> None:
    for name, added in (("base", ""), ("ours", ", c: {}"), ("theirs", ", d: {}")):
        (tmp_path / name).write_text(SMALL_PROJECT.replace("}}}}}", f"}}}}{added}}}}}}}"), encoding="utf-8")
    modules = imported_modules(tmp_path, "merge-driver", "base", "ours", "theirs", "archgen.yaml")
    assert "c: {}, d: {}" in (tmp_path / "ours").read_text(encoding="utf-8")
    assert "archgen.merge.slice_merge" in modules
    rooms = ("archgen.bringup", "archgen.checking", "archgen.compare.kinds", "archgen.link")
    assert [name for name in sorted(modules) if name.startswith(rooms)] == []


def test_a_check_imports_nothing_for_what_a_project_does_not_have(tmp_path: Path) -> None:
    modules = imported_modules(tmp_path, "check", str(RAMCIP))
    rooms = (
        "archgen.bringup.start_plan",  # no node waits for another one
        "archgen.compose.type_table",  # no component has a type
        "archgen.git",
        "archgen.link.port_sources",  # no component holds others
        "archgen.project.project_tracking",
        "archgen.schema.schema_wording",  # no file is wrong
        "archgen.timing.load.core_paths",  # no host has activities that fire one another on several cores
        "archgen.views",
    )
    assert [name for name in sorted(modules) if name.startswith(rooms)] == []
    assert HEAVY & modules == set()
