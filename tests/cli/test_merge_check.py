"""`archgen merge-check`: what would be wrong if open branches were merged, seen before anybody merges."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema_rs
import pytest

from archgen import resources
from tests import repositories
from tests.cli.conftest import Run

BASE = {
    "archgen.yaml": "archgen: 1\nproject: {id: mini}\nsources: ['groups/*.yaml']\nrequirements: {R-1: Stop, R-2: Go}\n",
    "groups/sense.yaml": "groups:\n  sense:\n    components:\n      eye: {outputs: {image: Image}}\n",
    "groups/drive.yaml": (
        "groups:\n  drive:\n    components:\n      base: {inputs: {image: eye.image}, requirements: [R-2]}\n"
    ),
}
EYE = "      eye: {outputs: {image: Image}}\n"


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    return repositories.repository(tmp_path / "robot", dict(BASE))


def branch(folder: Path, name: str, replacements: dict[str, tuple[str, str]]) -> None:
    """Commit a branch off main in which texts of files are replaced."""
    repositories.git(folder, "checkout", "-q", "-b", name, "main")
    repositories.commit(
        folder, {file: (folder / file).read_text().replace(old, new) for file, (old, new) in replacements.items()}
    )
    repositories.git(folder, "checkout", "-q", "main")


RENAMED = {"groups/sense.yaml": ("image: Image", "picture: Image"), "groups/drive.yaml": ("eye.image", "eye.picture")}
READS_OLD_NAME = {"archgen.yaml": ("sources", "groups: {x: {components: {new: {inputs: {i: eye.image}}}}}\nsources")}


def test_a_reader_of_a_name_that_another_branch_gave_up_is_found(run: Run, robot: Path) -> None:
    branch(robot, "rename", RENAMED)
    branch(robot, "reader", READS_OLD_NAME)
    ran = run("merge-check", "-C", robot, "main", "rename", "reader")
    assert ran.status == 1
    assert ran.out == (
        "main + rename: merges\n"
        "main + reader: merges\n"
        "main + rename + reader: merges, and then there are new findings\n"
        "error[unknown-reference]: no component or output named `eye.image`\n"
        "  --> archgen.yaml:3:45\n"
        "   3 | groups: {x: {components: {new: {inputs: {i: eye.image}}}}}\n"
        "     |                                             ^^^^^^^^^\n"
        "   = help: there is `sense.eye.picture`\n"
        "\n"
        "timing, views and unused elements are judged once these errors are gone\n"
        "1 error\n"
    )


def test_branches_that_go_together_are_said_to(run: Run, robot: Path) -> None:
    branch(robot, "one", {"groups/sense.yaml": (EYE, EYE + "      ear: {outputs: {sound: Sound}}\n")})
    branch(robot, "two", {"groups/drive.yaml": ("[R-2]", "[R-1, R-2]")})
    ran = run("merge-check", "-C", robot, "main", "one", "two")
    assert (ran.status, ran.out) == (0, "main + one: merges\nmain + two: merges\nmain + one + two: merges\n")


def test_conflicts_of_lines_that_the_models_do_not_have_are_told_as_such(run: Run, robot: Path) -> None:
    branch(robot, "ear", {"groups/sense.yaml": (EYE, EYE + "      ear: {outputs: {sound: Sound}}\n")})
    branch(robot, "nose", {"groups/sense.yaml": (EYE, EYE + "      nose: {outputs: {smell: Smell}}\n")})
    ran = run("merge-check", "-C", robot, "main", "ear", "nose")
    assert ran.status == 0
    assert ran.out.splitlines()[2:] == [
        "main + ear + nose: git conflicts needlessly",
        "  groups/sense.yaml: git conflicts, what both sides say does not: `archgen merge-driver` merges it",
        "main + ear + nose: merges",
    ]


def test_conflicts_of_the_models_are_named_and_the_branch_is_left_out_of_the_rest(run: Run, robot: Path) -> None:
    branch(robot, "depth", {"groups/sense.yaml": ("image: Image", "image: Depth")})
    branch(robot, "colour", {"groups/sense.yaml": ("image: Image", "image: Colour")})
    branch(robot, "more", {"groups/drive.yaml": ("[R-2]", "[R-1, R-2]")})
    ran = run("merge-check", "-C", robot, "main", "depth", "colour", "more")
    assert ran.status == 1
    assert ran.out.splitlines()[3:] == [
        "main + depth + colour: conflicts",
        "  groups/sense.yaml: both sides changed `groups.sense.components.eye.outputs.image`",
        "main + depth + more: merges",
    ]


FOLLOWED = "git conflicts, what both sides say does not: `archgen merge` merges it"
SPLIT = {
    "groups/eyes.yaml": "groups:\n  sense: {components: {eye: {outputs: {image: Image}}}}\n",
    "groups/ears.yaml": "groups:\n  sense: {components: {ear: {outputs: {sound: Sound}}}}\n",
}


@pytest.mark.parametrize(
    ("new_eye", "reason"),
    [
        ("image: Image", FOLLOWED),
        (
            "image: Colour",
            (
                "one side took it away or moved it, the other one changed it; both sides changed"
                " `groups.sense.components.eye.outputs.image.type`"
            ),
        ),
    ],
)
def test_a_file_that_one_side_split_says_whether_the_models_conflict(
    run: Run, robot: Path, new_eye: str, reason: str
) -> None:
    both = {"groups/sense.yaml": BASE["groups/sense.yaml"] + "      ear: {outputs: {sound: Sound}}\n"}
    repositories.commit(robot, both)
    branch(robot, "edit", {"groups/sense.yaml": ("image: Image", "image: Depth")})
    repositories.git(robot, "checkout", "-q", "-b", "split", "main")
    (robot / "groups/sense.yaml").unlink()
    repositories.commit(robot, {name: text.replace("image: Image", new_eye) for name, text in SPLIT.items()})
    repositories.git(robot, "checkout", "-q", "main")
    ran = run("merge-check", "-C", robot, "main", "edit", "split")
    lines = ran.out.splitlines()[2:]
    if reason == FOLLOWED:
        assert ran.status == 0
        assert lines[:2] == [
            "main + edit + split: git conflicts needlessly",
            "  followed: 2 entries of groups/sense.yaml stand in groups/eyes.yaml, groups/ears.yaml now",
        ]
        assert f"  groups/sense.yaml: {reason}" in lines
    else:
        assert (ran.status, lines) == (1, ["main + edit + split: conflicts", f"  groups/sense.yaml: {reason}"])


@pytest.mark.parametrize(
    ("new_eye", "reason"),
    [
        ("image: Image", FOLLOWED),
        ("image: Colour", "both sides changed `groups.sense.components.eye`"),
    ],
)
def test_what_one_side_moved_out_of_a_file_is_followed_unless_both_changed_it(
    run: Run, robot: Path, new_eye: str, reason: str
) -> None:
    ear = "      ear: {outputs: {sound: Sound}}\n"
    repositories.commit(robot, {"groups/sense.yaml": BASE["groups/sense.yaml"] + ear})
    branch(robot, "edit", {"groups/sense.yaml": ("image: Image", "image: Depth")})
    repositories.git(robot, "checkout", "-q", "-b", "split", "main")
    moved = SPLIT["groups/eyes.yaml"].replace("image: Image", new_eye)
    repositories.commit(
        robot, {"groups/sense.yaml": BASE["groups/sense.yaml"].replace(EYE, ear), "groups/eyes.yaml": moved}
    )
    repositories.git(robot, "checkout", "-q", "main")
    for branches in (("edit", "split"), ("split", "edit")):
        ran = run("merge-check", "-C", robot, "main", *branches)
        assert ran.status == (0 if reason == FOLLOWED else 1)
        assert f"  groups/sense.yaml: {reason}" in ran.out.splitlines()[3:]


def test_warnings_count_where_they_are_asked_to(run: Run, robot: Path) -> None:
    # Each branch takes one of two readers away; only together nobody is left.
    repositories.commit(
        robot, {"groups/more.yaml": "groups: {more: {components: {log: {inputs: {image: eye.image}}}}}\n"}
    )
    branch(robot, "one", {"groups/more.yaml": ("inputs: {image: eye.image}", "inputs: {}")})
    branch(robot, "two", {"groups/drive.yaml": ("inputs: {image: eye.image}", "inputs: {}")})
    ran = run("merge-check", "-C", robot, "main", "one", "two")
    assert "[unread-output]" in ran.out
    assert ran.status == 0
    assert run("merge-check", "-C", robot, "main", "one", "two", "--strict").status == 1


def test_the_json_holds_to_its_schema(run: Run, robot: Path) -> None:
    branch(robot, "rename", RENAMED)
    branch(robot, "reader", READS_OLD_NAME)
    branch(robot, "depth", {"groups/sense.yaml": ("image: Image", "image: Depth")})
    ran = run("merge-check", "-C", robot, "main", "rename", "reader", "depth", "--format", "json")
    schema = json.loads(resources.resource_path("schemas", "merges.schema.json").read_text(encoding="utf-8"))
    merges = json.loads(ran.out)
    jsonschema_rs.validate(schema, merges)
    assert [(merge["branches"], len(merge["new_findings"]), len(merge["conflicts"])) for merge in merges["merges"]] == [
        (["rename"], 0, 0),
        (["reader"], 0, 0),
        (["depth"], 0, 0),
        (["rename", "reader"], 1, 0),
        (["rename", "depth"], 0, 1),
        (["rename", "depth"], 0, 0),
    ]


@pytest.mark.parametrize("object_format", ["sha1", "sha256"])
def test_nothing_is_run_checked_out_or_left_behind(run: Run, tmp_path: Path, object_format: str) -> None:
    top = repositories.repository(
        tmp_path / "top",
        {f"robots/one/{name}": text for name, text in BASE.items()} | {".gitattributes": "*.yaml merge=evil\n"},
        f"--object-format={object_format}",
    )
    program, mark = repositories.trap(tmp_path)
    repositories.git(top, "config", "merge.evil.driver", str(program))
    robot = top / "robots/one"
    for name in ("ear", "nose"):
        branch(robot, name, {"groups/sense.yaml": (EYE, f"{EYE}      {name}: {{outputs: {{{name}: Image}}}}\n")})
    before = repositories.git(top, "count-objects", "-v"), repositories.git(top, "status", "--porcelain")
    ran = run("merge-check", "-C", robot, "main", "ear", "nose")
    assert ran.status == 0
    assert "needlessly" in ran.out
    assert (repositories.git(top, "count-objects", "-v"), repositories.git(top, "status", "--porcelain")) == before
    assert not mark.exists()


def test_what_cannot_be_merged_is_wrong_usage(run: Run, robot: Path) -> None:
    repositories.git(robot, "checkout", "-q", "--orphan", "stranger")
    repositories.commit(robot, {"groups/sense.yaml": "groups: {}\n"})
    repositories.git(robot, "checkout", "-q", "main")
    unrelated = run("merge-check", "-C", robot, "main", "stranger")
    assert unrelated.status == 2
    assert "refusing to merge unrelated histories" in unrelated.err
    unknown = run("merge-check", "-C", robot, "main", "nowhere")
    assert unknown.status == 2
    assert "there is no revision `nowhere`" in unknown.err


def test_a_branch_without_the_project_takes_it_away(run: Run, robot: Path) -> None:
    repositories.git(robot, "checkout", "-q", "-b", "gone")
    repositories.git(robot, "rm", "-q", "-r", ".")
    robot.mkdir(exist_ok=True)
    repositories.commit(robot, {"README": "x"})
    repositories.git(robot, "checkout", "-q", "main")
    ran = run("merge-check", "-C", robot, "main", "gone")
    assert (ran.status, ran.out) == (1, "main + gone: merges, but holds no project any more\n")


def test_at_the_top_of_a_repository_each_project_is_merged(run: Run, tmp_path: Path) -> None:
    files = {f"robots/{name}/{file}": text for name in ("one", "two") for file, text in BASE.items()}
    top = repositories.repository(tmp_path / "top", files)
    branch(top, "rename", {f"robots/one/{file}": texts for file, texts in RENAMED.items()})
    branch(top, "reader", {f"robots/one/{file}": texts for file, texts in READS_OLD_NAME.items()})
    ran = run("merge-check", "-C", top, "main", "rename", "reader")
    assert ran.status == 1
    assert [line for line in ran.out.splitlines() if "main + " in line] == [
        "robots/one: main + rename: merges",
        "robots/one: main + reader: merges",
        "robots/one: main + rename + reader: merges, and then there are new findings",
        "robots/two: main + rename: merges",
        "robots/two: main + reader: merges",
        "robots/two: main + rename + reader: merges",
    ]
    assert run("merge-check", "-C", top, "main", "rename").status == 0
    refused = run("merge-check", "-C", top, "main", "rename", "--format", "json")
    assert refused.status == 2
    assert "this folder only holds projects: name one with -C, such as `-C " in refused.err
