"""The verbs as people find them: in groups, by words that they try, with the same options wherever these make sense."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import click
import pytest

from archgen.cli import PLUMBING, VERB_GROUPS, VERBS
from archgen.syntax import yaml_parser
from tests.cli.conftest import Run
from tests.running import RAMCIP

ROBOT = """\
archgen: 1
partners: {wur: Wageningen, tud: Delft}
groups:
  g:
    components:
      stereo_camera: {owner: wur, functionality: Sees., tags: [safety], outputs: {image: Image}}
      screen: {owner: tud, inputs: {image: g.stereo_camera.image}}
"""


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    (tmp_path / "archgen.yaml").write_text(ROBOT, encoding="utf-8")
    return tmp_path


def test_the_help_has_six_groups_and_hides_plumbing(run: Run) -> None:
    text = run("--help").out
    headings = [line.rstrip(":") for line in text.splitlines() if line.endswith(":") and not line.startswith(" ")]
    assert headings[:-1] == ["Options", "Write", "Check", "Look", "Publish", "Agree", "Exchange"]
    assert headings[-1] == "For git, editors, shells and workflows"
    assert all(f"\n  {verb} " in text for group in VERB_GROUPS.values() for verb in group)
    assert not any(f"\n  {verb} " in text.replace("\n  schema, ", "") for verb in PLUMBING)
    assert sorted(VERBS) == sorted({*PLUMBING, *(verb for group in VERB_GROUPS.values() for verb in group)})


def test_words_that_people_try(run: Run) -> None:
    assert run("help").out == run("--help").out
    assert run("help", "check").out == run("check", "--help").out
    assert run("version").out == run("--version").out


@pytest.mark.parametrize("verb", ["check", "review", "timing", "stats", "list", "show", "owners"])
def test_each_takes_the_project_as_an_option(run: Run, verb: str) -> None:
    assert "-C, --project" in run(verb, "--help").out


def test_what_can_be_made_is_listed_where_nothing_is_named(run: Run) -> None:
    ran = run("export")
    assert (ran.status, "Error: name what to make: d2, graphml, mermaid, " in ran.err) == (2, True)
    assert "ros2" in run("generate").err


def test_an_element_in_the_place_of_the_project_is_told(run: Run) -> None:
    ran = run("timing", "object_recognition", "-C", RAMCIP)
    assert ran.status == 2
    assert "object_recognition is no folder: what stands here is the project, which -C names already;" in ran.err
    assert ran.err.endswith("; elements are named behind --why\n")


@pytest.mark.parametrize(
    ("selector", "guess"),
    [("tag:safty", "tag:safety"), ("owner:wurr", "owner:wur"), ("node:screeen", "node:screen"), ("owner:nobody", None)],
)
def test_values_of_selectors_are_guessed(run: Run, robot: Path, selector: str, guess: str | None) -> None:
    end = f"; did you mean `{guess}`?" if guess else ""
    assert run("list", selector, "-C", robot).err == f"warning: nothing has `{selector}`{end}\n"


def test_a_part_of_a_name_is_guessed(run: Run, robot: Path) -> None:
    assert "nothing is called `stereo`; did you mean `stereo_camera`?" in run("show", "stereo", "-C", robot).err
    assert "did you mean" not in run("show", "xyz", "-C", robot).err


def test_a_list_and_statistics_of_a_part(run: Run, robot: Path) -> None:
    assert run("list", "--select", "owner:wur", "-C", robot).out == run("list", "owner:wur", "-C", robot).out
    lines = run("stats", robot, "--select", "owner:wur").out.splitlines()
    assert "Delft" not in "\n".join(lines)
    assert "Wageningen" in "\n".join(lines)
    assert run("stats", robot, "--history", "--select", "g").status == 2


def test_types_that_ship_are_listed_before_there_is_a_project(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert "ros.amcl" in run("list", "--of", "component_types", "--library", "builtin").out
    assert run("list", "--of", "component_types").status == 2
    assert run("list", "--of", "component_types", "--library", "builtin", "-C", "gone").status == 2


def test_watching_checks_again_when_a_file_is_saved(run: Run, robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[object] = []

    def save_once(choose_places: Callable[[], object], on_change: Callable[[], object], _stopped: object) -> None:
        seen.append(choose_places())
        (robot / "archgen.yaml").write_text(ROBOT.replace("g.stereo_camera.image", "g.stereo.image"), encoding="utf-8")
        on_change()

    monkeypatch.setattr("archgen.live.file_watch.watch_files", save_once)
    ran = run("check", robot, "--watch", "-q")
    first, second = click.unstyle(ran.out).split("--- a file was saved\n")
    assert (first, "no output named `g.stereo.image`" in second, len(seen)) == ("", True, 1)
    assert run("check", robot, "--watch", "--format", "json").status == 2


def test_watching_reads_again_only_what_was_saved(run: Run, robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    parsed: list[str] = []

    def parse(file: str, text: str) -> object:
        parsed.append(file)
        return parse_yaml(file, text)

    def save_twice(_places: object, on_change: Callable[[], object], _stopped: object) -> None:
        for name in ("stereo", "stereo_camera"):
            text = ROBOT.replace("g.stereo_camera.image", f"g.{name}.image")
            (robot / "archgen.yaml").write_text(text, encoding="utf-8")
            on_change()

    (robot / "more.yaml").write_text("groups: {more: {title: More}}\n", encoding="utf-8")
    parse_yaml = yaml_parser.parse_yaml
    monkeypatch.setattr(yaml_parser, "parse_yaml", parse)
    monkeypatch.setattr("archgen.live.file_watch.watch_files", save_twice)
    first, second, third = click.unstyle(run("check", robot, "--watch").out).split("--- a file was saved\n")
    assert parsed == ["archgen.yaml", "more.yaml", "archgen.yaml", "archgen.yaml"]
    assert "no output named `g.stereo.image`" in second
    assert first == third


@pytest.mark.parametrize(
    ("parameter", "told"),
    [
        ("{type: double, value: 1, limits: [0, 3]}", True),
        ("{value: 2, limits: [0, 3]}", True),
        ("{value: 2, range: [0, 3]}", False),
        ("{limits: [0, 3], speed: 2}", False),  # a set of parameters
    ],
)
def test_a_slip_in_the_declaration_of_a_parameter_is_told(run: Run, robot: Path, parameter: str, *, told: bool) -> None:
    text = ROBOT.replace("functionality: Sees.", f"functionality: Sees., parameters: {{gain: {parameter}}}")
    (robot / "archgen.yaml").write_text(text, encoding="utf-8")
    assert ("`gain` has no key `limits`" in run("check", robot).out) is told
