"""Generators of packages that others install: the example of docs/own_generators.md, and packages that are no good."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import sysconfig
import tomllib
import venv
from collections.abc import Iterator
from pathlib import Path

import pytest

from archgen import installed_plugins
from archgen.installed_backends import list_installed_backends
from archgen.resources import SWITCH_VARIABLE
from archgen.views.generation import find_view_maker
from tests.installed_packages import installed_in
from tests.running import ROOT, archgen_here, contents

PROJECT = """\
archgen: 1
project: {id: robot}
groups: {g: {components: {a: {functionality: Grips.}, b: {functionality: Looks.}}}}
hosts: {pc: {}}
nodes: {left: {implements: g.a, host: pc}, right: {implements: g.b, hints: {roster: {colour: red}}}}
"""
ROSTER = {"roster.txt": b"left: pc\nright: nowhere yet\n"}
OWN_BACKEND = """\
{id: table, title: Table, emitter: text, makes: workspace, view: roster, files: [{template: t.j2, path: t}]}
"""


def install(folder: Path, *changes: tuple[str, str]) -> None:
    """Put the package of the page into a folder as an installer does, with some words changed."""
    page = (ROOT / "docs" / "own_generators.md").read_text("utf-8").partition("\n## Views in Python\n")[2]
    for written in re.findall(r"```\w+\n(.*?)```", page.partition("\n## ")[0], re.DOTALL):
        text = written
        for old, new in changes:
            text = text.replace(old, new)
        path = folder / written.splitlines()[0].strip("#{} ")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text.partition("\n")[2], "utf-8")
    about = tomllib.loads((folder / "pyproject.toml").read_text("utf-8"))["project"]
    record = folder / f"{about['name'].replace('-', '_')}-{about['version']}.dist-info"
    record.mkdir()
    entries = [
        f"[{group}]\n" + "".join(f"{name} = {target}\n" for name, target in points.items())
        for group, points in about["entry-points"].items()
    ]
    (record / "entry_points.txt").write_text("\n".join(entries), "utf-8")


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    folder = tmp_path / "robot"
    folder.mkdir()
    (folder / "archgen.yaml").write_text(PROJECT, "utf-8")
    return folder


def test_the_example_of_the_page_in_a_python_where_it_is_installed(robot: Path, tmp_path: Path) -> None:
    venv.create(tmp_path / "venv", symlinks=True)
    python = tmp_path / "venv" / "bin" / "python"
    (site,) = (tmp_path / "venv" / "lib").glob("python*/site-packages")
    install(site)
    libraries = dict.fromkeys((sysconfig.get_path("purelib"), sysconfig.get_path("platlib"), str(ROOT)))
    (site / "libraries_of_the_tests.pth").write_text("".join(f"{path}\n" for path in libraries), "utf-8")
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    done = subprocess.run(  # noqa: S603 - our own program
        [python, "-m", "archgen", "generate", "roster", "-o", tmp_path / "ws"],
        cwd=robot,
        env=environment | {"XDG_CACHE_HOME": str(tmp_path / "cache")},
        capture_output=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, b"")
    assert {name: data for name, data in contents(tmp_path / "ws").items() if not name.startswith(".")} == ROSTER


@pytest.fixture
def site(tmp_path: Path) -> Iterator[Path]:
    """Give a folder of installed packages that this process has, too; a package is put there before archgen looks."""
    with installed_in(tmp_path / "site-packages"):
        yield tmp_path / "site-packages"


def test_its_backends_are_listed_behind_those_that_ship(site: Path, robot: Path) -> None:
    install(site)
    assert list(list_installed_backends())[-1] == "roster"
    said = archgen_here("list", "--of", "backends", cwd=robot).stdout.decode()
    assert re.search(r"^roster +Roster of nodes +workspace +text +roster +archgen-roster 1\.0$", said, re.MULTILINE)
    assert (
        "roster" not in archgen_here("list", "--of", "backends", cwd=robot, env={SWITCH_VARIABLE: "1"}).stdout.decode()
    )


def test_a_projects_own_backend_may_take_its_view(site: Path, robot: Path, tmp_path: Path) -> None:
    install(site)
    (robot / "backends/table/templates").mkdir(parents=True)
    (robot / "backends/table/backend.yaml").write_text(OWN_BACKEND, "utf-8")
    (robot / "backends/table/templates/t.j2").write_text("{{ roster.nodes|length }}", "utf-8")
    archgen_here("generate", "table", "-o", tmp_path / "ws", cwd=robot)
    assert (tmp_path / "ws" / "t").read_text("utf-8") == "2"


def test_hints_for_it_are_held_against_its_schema(site: Path, robot: Path) -> None:
    install(
        site,
        (
            "view: roster",
            "view: roster\nhints_schema: {node: {type: object, properties: {tag: {type: string}}, additionalProperties: false}}",
        ),
    )
    said = archgen_here("check", cwd=robot, status=1).stdout.decode()
    assert "archgen.yaml:5:" in said
    assert "wrong-hint" in said
    assert "archgen_roster" not in sys.modules, "`check` imports no generator"


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (
            "roster/",
            "wiki/",
            "the generator `roster` of archgen-roster 1.0 cannot be used: archgen has a backend `wiki` already",
        ),
        (
            '{"roster": "',
            '{"aadl": "',
            "the generator `roster` of archgen-roster 1.0 cannot be used: there is a view `aadl` already",
        ),
        ('{"roster": "', '{"item": "', "cannot be used: `item` cannot be the name of a view"),
        ('"views"', '"pages"', "cannot be used: a generator has no pages"),
        (
            "GeneratedView({",
            "({",
            "the view `roster` of archgen-roster 1.0 fails: `archgen_roster:make_view` returns no GeneratedView",
        ),
        ("wanted_nodes.values()", "nobody", "the view `roster` of archgen-roster 1.0 fails: AttributeError: "),
        (':make_view"', ':make_nothing"', "cannot be loaded: `archgen_roster:make_nothing`: AttributeError: "),
    ],
)
def test_a_package_that_is_no_good_is_named(  # noqa: PLR0913, PLR0917 - what is wrong, and where
    old: str, new: str, said: str, site: Path, robot: Path, tmp_path: Path
) -> None:
    install(site, (old, new))
    if old == "roster/":
        (site / "archgen_roster/backends/roster").rename(site / "archgen_roster/backends/wiki")
    err = archgen_here("generate", "roster", "-o", tmp_path / "ws", cwd=robot, status=2).stderr.decode()
    assert err.startswith("Error: ")
    assert said in err
    assert not (tmp_path / "ws").exists()


def test_a_manifest_that_is_no_good_is_told_with_its_place(site: Path, robot: Path, tmp_path: Path) -> None:
    install(site, ("emitter: text", "emitter: site"))
    err = archgen_here("generate", "roster", "-o", tmp_path / "ws", cwd=robot, status=2).stderr.decode()
    assert "archgen-roster/backends/roster/backend.yaml:" in err
    assert "a backend of another package has the emitter `text`, not `site`" in err


def test_what_documents_are_made_from_is_no_view_for_generators(site: Path) -> None:
    install(site, ("PLUGIN =", "1 / 0  #"))
    assert find_view_maker("record") is None
    assert find_view_maker("structure")
    with pytest.raises(installed_plugins.PluginRefusedError, match="ZeroDivisionError"):
        find_view_maker("roster")
