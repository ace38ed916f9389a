"""`archgen explain ros.TYPE`: where the facts about a component type that ships were read."""

from __future__ import annotations

import pytest

from archgen.cli.type_sources import list_shipped_names, list_source_lines
from archgen.project.shipped_sources import read_shipped_sources
from tests.cli.conftest import Run


def test_each_distribution_has_a_line_for_each_source(run: Run) -> None:
    lines = run("explain", "ros.amcl").out.splitlines()
    assert [line.partition(":")[0] for line in lines] == ["jazzy", "humble", "kilted", "lyrical", "noetic"]
    source = read_shipped_sources("jazzy")["amcl"][0]
    assert lines[0] == f"jazzy: source text of version {source.version}, {source.date}, {source.format_link()}"


def test_a_distribution_shows_file_and_line_of_each_fact(run: Run) -> None:
    lines = run("explain", "ros.amcl", "--distro", "noetic").out.splitlines()
    [source] = read_shipped_sources("noetic")["amcl"]
    facts = {fact: (file, line) for file, lines_of in source.files.items() for fact, line in lines_of.items()}
    assert len(lines) == 1 + len(facts)
    assert f"  inputs.scan: {source.format_link(*facts['inputs.scan'])}" in lines


def test_a_version_that_is_not_the_released_one_says_so() -> None:
    sources = read_shipped_sources("jazzy")
    name, old_source = next((n, s) for n, each in sources.items() for s in each if s.version != s.released)
    assert any(
        f"version {old_source.version} ({old_source.released} is released)" in line
        for line in list_source_lines(f"ros.{name}", "jazzy")
    )


def test_names_are_those_of_all_distributions() -> None:
    names = list_shipped_names()
    assert {"ros.gmapping", "ros.planner_server"} <= set(names)
    assert list(names) == sorted(names)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("ros.amlc",), "no component type named 'ros.amlc' ships with archgen; did you mean `ros.amcl`?"),
        (("x.y",), "no component type named 'x.y' ships with archgen"),
        (("--distro", "jazzy"), "--distro goes with a component type that ships, such as `ros.amcl`"),
        (("ros.amcl", "--distro", "foxy"), "nothing ships for the distribution 'foxy'; there are jazzy"),
        (("ros.amcl", "--distro", "rolling"), "'ros.amcl' does not ship for rolling; `archgen explain ros.amcl`"),
    ],
)
def test_what_does_not_ship_is_told(run: Run, words: tuple[str, ...], message: str) -> None:
    ran = run("explain", *words)
    assert ran.status == 2
    assert message in ran.err
