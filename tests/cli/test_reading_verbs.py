"""The verbs that only read: check, stats, show, list, explain, on a sound project and on a broken one."""

from __future__ import annotations

import json
import re
from pathlib import Path

import jsonschema_rs
import pytest

from archgen import resources
from tests.cli.conftest import Run

ERROR = """\
error[unknown-reference]: no component or output named `camera.imgae`
  --> archgen.yaml:6:32
   6 |       screen: {inputs: {image: camera.imgae}}
     |                                ^^^^^^^^^^^^
"""


def test_check_of_a_sound_project(run: Run, first: Path) -> None:
    ran = run("check", first)
    assert (ran.status, ran.err) == (0, "")
    assert ran.out.startswith(
        "note[borrowed-message]: the mapper that ships with archgen alone says what these types are: `Colour image`"
    )
    assert ran.out.endswith("\n1 note\n")


def test_check_of_a_broken_project(run: Run, broken: Path) -> None:
    ran = run("check", broken)
    assert (ran.status, ran.err) == (1, "")
    assert ERROR in ran.out
    assert "   = help: did you mean `camera.image`?\n" in ran.out
    assert ran.out.splitlines()[-1].startswith("1 error")


def test_quiet_shows_errors_only(run: Run, broken: Path) -> None:
    ran = run("check", "-q", broken)
    assert ran.out.startswith(ERROR)
    assert ran.out.splitlines()[-1] == "1 error"


def test_strict_counts_warnings(run: Run, first: Path) -> None:
    (first / "more.yaml").write_text("nodes: {idle: {title: Idle}}\n", encoding="utf-8")
    assert run("check", first).status == 0
    assert run("check", "--strict", first).status == 1


def test_json_follows_its_schema(run: Run, broken: Path) -> None:
    ran = run("check", "--format", "json", broken)
    data = json.loads(ran.out)
    schema = json.loads(resources.resource_path("schemas", "diagnostics.schema.json").read_text(encoding="utf-8"))
    assert list(jsonschema_rs.Draft202012Validator(schema).iter_errors(data)) == []
    assert data["summary"]["error"] == 1
    (error,) = (d for d in data["diagnostics"] if d["severity"] == "error")
    assert error["span"]["start"] == {"line": 6, "column": 32}


def test_github_annotations_are_relative_to_the_workspace(
    run: Run, broken: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("GITHUB_WORKSPACE", str(broken.parent))
    ran = run("check", "--format", "github", broken)
    assert "::error file=broken/archgen.yaml,line=6,endLine=6,col=32,endColumn=44,title=unknown-reference::" in ran.out


def test_the_project_around_the_current_folder(run: Run, first: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (first / "deep" / "er").mkdir(parents=True)
    monkeypatch.chdir(first / "deep" / "er")
    assert run("check").out.endswith("\n1 note\n")


@pytest.mark.parametrize("words", [("check",), ("stats",), ("pack",), ("list", "-C"), ("show", "x", "-C")])
def test_a_project_that_is_not_there_is_wrong_usage(run: Run, tmp_path: Path, words: tuple[str, ...]) -> None:
    ran = run(*words, tmp_path / "nowhere")
    assert (ran.status, ran.out) == (2, "")
    assert ran.err.endswith(f"Error: {tmp_path / 'nowhere'} does not exist\n")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("chek",), "there is no verb 'chek'; did you mean `check`?"),
        (("check", "--format", "xml"), "'xml' is not one of 'text', 'json', 'github'"),
        (("check", "--fast"), "No such option '--fast'"),
        (("check", "a", "b"), "not files of one project"),
        (("show",), "Missing argument"),
        (("explain", "unread-outputs"), "there is no rule 'unread-outputs'; did you mean `unread-output`?"),
        (("list", "--of", "things"), "'things' is not one of"),
    ],
)
def test_wrong_usage(run: Run, words: tuple[str, ...], said: str) -> None:
    ran = run(*words)
    assert (ran.status, ran.out) == (2, "")
    assert said in ran.err


def test_stats(run: Run, first: Path, broken: Path) -> None:
    ran = run("stats", first)
    assert (ran.status, ran.err) == (0, "")
    assert ran.out.startswith("Parcel Robot\n\n")
    data = json.loads(run("stats", "--format", "json", first).out)
    assert (data["version"], data["files"], data["components"]) == (1, 1, 10)
    ran = run("stats", broken)
    assert ran.status == 1
    assert ERROR in ran.err
    assert "unknown-reference" not in ran.out


def test_show(run: Run, first: Path) -> None:
    ran = run("show", "obstacle_stop", "-C", first)
    assert ran.status == 0
    assert ran.out.startswith("component navigation.obstacle_stop - Obstacle Stop   archgen.yaml:")
    assert "    velocity (Velocity command) -> devices.drive.velocity\n" in ran.out


def test_show_does_not_hide_a_component_behind_its_node_or_a_frame(run: Run, tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(
        """\
archgen: 1
groups:
  g:
    components:
      eye: {outputs: {o: std_msgs/msg/Empty}, frames: {eye: {parent: base, static: true}}, node: {package: p, executable: e}}
      pair: {components: {left: {title: Left}}}
frames: {pair: {parent: base, static: true}}
""",
        encoding="utf-8",
    )
    heads = {
        word: [
            line.split("   ")[0] for line in run("show", word, "-C", tmp_path).out.splitlines() if line[:1].isalpha()
        ]
        for word in ("eye", "pair", "g.eye")
    }
    assert heads == {
        "eye": ["component g.eye - Eye", "node eye - Eye", "frame eye"],
        "pair": ["composed g.pair - Pair", "frame pair"],
        "g.eye": ["component g.eye - Eye"],
    }


def test_show_what_is_not_there(run: Run, first: Path) -> None:
    ran = run("show", "obstacle_stp", "-C", first)
    assert (ran.status, ran.out) == (2, "")
    assert ran.err.endswith("\n\nError: nothing is called `obstacle_stp`; did you mean `obstacle_stop`?\n")


@pytest.mark.parametrize(("word", "help_text"), [("obstacle_stp", "did you mean `obstacle_stop`?"),
                                                 ("zzzzzz", "`archgen list` gives the names of all elements")])  # fmt: skip
@pytest.mark.parametrize("words", [("show",), ("list",), ("timing", "--why"), ("pack", "--resolved", "--select")])
def test_a_name_that_nothing_has_is_told_in_the_same_words(
    run: Run, first: Path, words: tuple[str, ...], word: str, help_text: str
) -> None:
    ran = run(*words, word, "-C", first)
    assert (ran.status, ran.out) == (2, "")
    assert ran.err.splitlines()[-1] == f"Error: nothing is called `{word}`; {help_text}"


@pytest.mark.parametrize(
    ("word", "meant"),
    [
        ("nodes", "archgen list --of nodes"),
        ("backend", "archgen list --of backends"),
        ("safety", "tag:safety"),
        ("acme_drivers", "package:acme_drivers"),
    ],
)
def test_what_is_no_name_of_an_element_is_taken_for_what_it_is(run: Run, first: Path, word: str, meant: str) -> None:
    (first / "more.yaml").write_text("nodes: {extra: {package: acme_drivers, executable: e, status: planned}}\n")
    ran = run("list", word, "-C", first)
    assert ran.err.splitlines()[-1] == f"Error: nothing is called `{word}`; did you mean `{meant}`?"


def test_the_project_is_named_by_position_or_as_an_option_but_once(run: Run, first: Path) -> None:
    assert run("stats", first) == run("stats", "-C", first) == run("stats", "--project", first)
    ran = run("stats", first, "-C", first)
    assert (ran.status, ran.out) == (2, "")
    assert f"the project is named twice: {first} and -C {first}" in ran.err
    ran = run("stats", "9" * 5000, "-C", first)  # no system has such a file
    assert (ran.status, "is no folder: what stands here is the project" in ran.err) == (2, True)


def test_history_without_a_repository_says_where_it_is_read_from(run: Run, first: Path) -> None:
    ran = run("stats", "--history", first)
    assert ran.status == 2
    assert ran.err.endswith("is not in a git repository: run `git init` first; the history is read from its commits\n")


def test_list(run: Run, first: Path) -> None:
    ran = run("list", "tag:safety", "-C", first)
    assert ran.status == 0
    assert [line.split()[0] for line in ran.out.splitlines()] == ["id", "navigation.obstacle_stop"]
    ran = run("list", "--format", "csv", "-C", first, "--", "-navigation", "-service")
    assert [row.split(",")[0] for row in ran.out.splitlines()] == [
        "id", "devices.lidar", "devices.camera", "devices.drive", "devices.loudspeaker",
    ]  # fmt: skip
    data = json.loads(run("list", "--of", "edges", "--format", "json", "-C", first).out)
    assert "navigation.obstacle_stop.velocity" in {row["output"] for row in data}


@pytest.mark.parametrize("sort", ["components", "nodes", "groups", "connections", "edges", "topics", "types",
                                  "requirements", "chains", "hosts"])  # fmt: skip
@pytest.mark.parametrize("form", ["text", "csv", "json"])
def test_every_list_of_a_broken_project(run: Run, broken: Path, sort: str, form: str) -> None:
    ran = run("list", "--of", sort, "--format", form, "-C", broken)
    assert ran.status == 1
    assert ERROR in ran.err
    assert "unknown-reference" not in ran.out


def test_a_wrong_selector_is_explained(run: Run, first: Path) -> None:
    ran = run("list", "lidr", "tga:x", "-C", first)
    assert (ran.status, ran.out) == (2, "")
    assert ran.err.endswith(
        "Error: no key `tga`; did you mean `tag:`?\nnothing is called `lidr`; did you mean `lidar`?\n"
    )


def test_explain(run: Run) -> None:
    assert run("explain", "unread-output").out.startswith("unread-output (warning)\n")
    names = [line.split()[0] for line in run("explain").out.splitlines()]
    assert names == sorted(names)
    assert "merge-conflict" in names


def test_a_rule_is_known_by_the_name_that_it_had(run: Run, tmp_path: Path) -> None:
    robot = """\
archgen: 1
project: {id: robot}
rules: {unactivated-node: %s}
groups: {g: {components: {a: A, b: B}}}
nodes:
  a: {implements: a, kind: lifecycle, start: {phase: core}}
  b: {implements: b, kind: lifecycle}%s
"""
    (tmp_path / "archgen.yaml").write_text(robot % ("error", "  # archgen: ignore[unactivated-node] by hand"))
    ran = run("check", tmp_path)
    assert "error[silent-node]: nobody activates the lifecycle node `a`" in ran.out
    assert [words for words in ("lifecycle node `b`", "unknown-rule", "unused-ignore") if words in ran.out] == []
    (tmp_path / "archgen.yaml").write_text(robot % ('"off"', ""))
    assert "silent-node" not in run("check", tmp_path).out
    assert run("explain", "unactivated-node").out == run("explain", "silent-node").out
    baseline = tmp_path / "known.yaml"
    (tmp_path / "archgen.yaml").write_text(robot % ("error", ""))
    assert run("check", tmp_path, "--baseline", baseline, "--update-baseline").status == 0
    baseline.write_text(baseline.read_text().replace("silent-node", "unactivated-node"))
    assert "silent-node" not in run("check", tmp_path, "--baseline", baseline).out


def test_version_and_help(run: Run) -> None:
    assert run("--version").out.startswith("archgen ")
    ran = run("--help")
    assert ran.status == 0
    assert "  check        Find mistakes in the architecture; --fix mends slips of form.\n" in ran.out


def test_show_says_whether_the_chains_of_a_requirement_are_in_time(run: Run, tmp_path: Path) -> None:
    text = (
        "archgen: 1\nrequirements: {R-1: Stops}\nhosts: {pc: {cores: 2}}\n"
        "groups: {g: {components: {a: {outputs: {o: std_msgs/msg/Bool}}, b: {inputs: {i: a.o}}}}}\n"
        "nodes:\n  a: {implements: a, host: pc, timing: {period: 50 ms, wcet: 5 ms}}\n"
        "  b: {implements: b, host: pc, timing: {wcet: 5 ms}}\n"
        "chains: {k: {through: [g.a, g.b], deadline: 10 ms, requirements: [R-1]}}\n"
    )
    (tmp_path / "archgen.yaml").write_text(text, encoding="utf-8")
    assert "  served by:\n    the chain k (missed)\n" in run("show", "R-1", "-C", tmp_path).out
    shown_chain = run("show", "k", "-C", tmp_path).out
    assert "  state:          missed\n  requirements:   R-1\n" in shown_chain
    # Where nobody has written a time, nobody knows: `timing` and the site say so, too.
    untimed = re.sub(r", timing: \{[^}]*\}", "", text)
    (tmp_path / "archgen.yaml").write_text(untimed, encoding="utf-8")
    assert "  state:          open\n" in run("show", "k", "-C", tmp_path).out
    (listed,) = json.loads(run("list", "--of", "requirements", "--format", "json", "-C", tmp_path).out)
    assert listed["state"] == "open"


def test_a_terminal_of_80_columns_shows_progress_as_a_table(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    title = "Robotic Assistant for Patients at Home, with a long name"
    components = ", ".join(f"c{n}: {{functionality: Runs.}}" for n in range(12))
    text = f'project: {{title: "{title}"}}\ngroups: {{g: {{components: {{{components}}}}}}}\n'
    (tmp_path / "robot.yaml").write_text(text, encoding="utf-8")
    monkeypatch.setattr("archgen.cli.stats_command.find_width", lambda _stream: 80)
    lines = run("stats", tmp_path / "robot.yaml").out.splitlines()
    heading = next(line for line in lines if "described" in line)
    assert heading.split() == ["Components", "total", "described", "typed", "mapped", "timed", "traced"]
    assert not any("described:" in line for line in lines)
    assert max(map(len, lines)) <= 80


def test_show_gives_data_too(run: Run, first: Path) -> None:
    (card,) = json.loads(run("show", "obstacle_stop", "--format", "json", "-C", first).out)
    assert (card["kind"], card["id"], card["place"]) == (
        "component",
        "navigation.obstacle_stop",
        {"file": "archgen.yaml", "line": 105, "column": 7},
    )
    assert set(card) == {"kind", "id", "title", "place", "facts", "lists"}
    assert all(isinstance(items, list) for items in card["lists"].values())
