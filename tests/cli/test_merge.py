"""`archgen merge`: a branch merged into what is checked out, what was renamed or moved followed, nothing half written."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema_rs
import pytest

from archgen import resources
from tests import repositories
from tests.cli.conftest import Run
from tests.property_sizes import try_some

EYE = "      # Looks ahead.\n      eye:\n        title: Eye\n        outputs: {image: Image}\n"
EAR = "      ear:\n        title: Ear\n        outputs: {sound: Sound}\n"
BASE_NAMES = ("inputs: {image: eye.image}", "title: Base")
FILES = {
    "archgen.yaml": "archgen: 1\nproject: {id: mini}\nsources: ['groups/*.yaml']\n",
    "groups/sense.yaml": f"groups:\n  sense:\n    components:\n{EYE}{EAR}",
    "groups/drive.yaml": (
        "groups:\n  drive:\n    components:\n      base:\n        title: Base\n        inputs: {image: eye.image}\n"
        "      horn:\n        inputs: {sound: ear.sound}\n"
    ),
    "README": "read me\n",
}


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    return repositories.repository(tmp_path / "robot", dict(FILES))


def commit_branch(folder: Path, name: str, files: dict[str, str | None]) -> None:
    """Commit a branch off main with some files written (None: taken away), and go back to main."""
    repositories.git(folder, "checkout", "-q", "-b", name, "main")
    for file, text in files.items():
        if text is None:
            (folder / file).unlink()
    repositories.commit(folder, {file: text for file, text in files.items() if text is not None})
    repositories.git(folder, "checkout", "-q", "main")


def replaced(file: str, *pairs: tuple[str, str]) -> dict[str, str | None]:
    text = FILES[file]
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    return {file: text}


def state(folder: Path) -> tuple[str, ...]:
    """Return all that a merge may change."""
    files = sorted(path for path in folder.rglob("*") if path.is_file() and ".git" not in path.parts)
    git = (repositories.git(folder, *words) for words in (("status", "--porcelain"), ("rev-parse", "HEAD")))
    return (*git, *(f"{path}: {path.read_text()}" for path in files))


RENAMED = {
    **replaced("groups/sense.yaml", ("eye:", "camera:")),
    **replaced("groups/drive.yaml", ("eye.image", "camera.image")),
}
SPLIT = {
    "groups/sense.yaml": None,
    "groups/eyes.yaml": f"groups:\n  sense:\n    components:\n{EYE}",
    "groups/ears.yaml": f"groups:\n  sense:\n    components:\n{EAR}",
}
GRAPH = {
    "groups/log.yaml": "groups:\n  log:\n    components:\n      logger:\n        inputs: {image: eye.image}\n",
    **replaced("groups/sense.yaml", ("title: Eye", "title: Eyes"), ("title: Ear", "title: Ears")),
    "README": "read me first\n",
}


@pytest.mark.parametrize("is_ours", [True, False])
@pytest.mark.parametrize("change", try_some(["rename and split", "rename", "split"]))
def test_what_one_side_renamed_or_split_off_takes_what_the_other_one_changed(
    run: Run, robot: Path, change: str, *, is_ours: bool
) -> None:
    files = dict(RENAMED) if "rename" in change else {}
    if "split" in change:
        files |= SPLIT
    if change == "rename and split":
        files["groups/eyes.yaml"] = (SPLIT["groups/eyes.yaml"] or "").replace("eye:", "camera:")
    commit_branch(robot, "moved", files)
    commit_branch(robot, "edited", GRAPH)
    ours, theirs = ("moved", "edited") if is_ours else ("edited", "moved")
    repositories.git(robot, "checkout", "-q", ours)
    dry = run("merge", theirs, "-C", robot, "--dry-run")
    assert (dry.status, repositories.git(robot, "status", "--porcelain")) == (0, "")
    ran = run("merge", theirs, "-C", robot)
    assert ran.status == 0, ran.out
    name = "camera" if "rename" in change else "eye"
    eyes = "groups/eyes.yaml" if "split" in change else "groups/sense.yaml"
    assert f"      # Looks ahead.\n      {name}:\n        title: Eyes\n" in (robot / eyes).read_text()
    assert "title: Ears" in (robot / eyes.replace("eyes", "ears")).read_text()
    assert (robot / "groups/sense.yaml").exists() == ("split" not in change)
    assert f"{{image: {name}.image}}" in (robot / "groups/log.yaml").read_text()
    assert (robot / "README").read_text() == "read me first\n"
    assert run("check", "-C", robot).status == 0
    assert "followed: " in ran.out
    assert ran.out.splitlines()[0] == f"{ours} + {theirs}: merges"
    repositories.git(robot, "commit", "-q", "--no-edit")
    assert repositories.git(robot, "rev-parse", "HEAD^2") == repositories.git(robot, "rev-parse", theirs)
    assert repositories.git(robot, "status", "--porcelain") == ""
    assert run("merge", theirs, "-C", robot).out == f"{ours} has all of {theirs} already\n"


@pytest.mark.parametrize(
    ("ours", "theirs", "reason"),
    try_some(
        [
            (
                RENAMED,
                {
                    **replaced("groups/sense.yaml", ("eye:", "lens:")),
                    **replaced("groups/drive.yaml", ("eye.image", "lens.image")),
                },
                "both sides renamed the component `sense.eye`: it is `sense.camera` and `sense.lens` now",
            ),
            (
                RENAMED,
                {
                    **replaced("groups/sense.yaml", (EYE, "")),
                    **replaced("groups/drive.yaml", ("        inputs: {image: eye.image}\n", "")),
                },
                "one side renamed the component `sense.eye` to `sense.camera`, the other one took it away",
            ),
            (
                SPLIT,
                replaced("groups/sense.yaml", ("    components:\n" + EYE, "    components:\n"))
                | {"groups/other.yaml": f"groups:\n  sense:\n    components:\n{EYE}"},
                "both sides moved `groups.sense.components.eye`: to groups/eyes.yaml and to groups/other.yaml",
            ),
            (
                replaced("groups/sense.yaml", ("title: Eye", "title: Left")),
                replaced("groups/sense.yaml", ("title: Eye", "title: Right")),
                "both sides changed `groups.sense.components.eye.title`",
            ),
            (
                replaced("groups/sense.yaml", (EYE, ""))
                | replaced("groups/drive.yaml", ("        inputs: {image: eye.image}\n", "")),
                {"groups/log.yaml": GRAPH["groups/log.yaml"]},
                "error[unknown-reference]: no component or output named `eye.image`",
            ),
        ],
        2,
    ),
)
def test_what_contradicts_is_named_and_nothing_is_written(
    run: Run, robot: Path, ours: dict[str, str | None], theirs: dict[str, str | None], reason: str
) -> None:
    commit_branch(robot, "ours", ours)
    commit_branch(robot, "theirs", theirs)
    for one, other in (("ours", "theirs"), ("theirs", "ours")):
        repositories.git(robot, "checkout", "-q", one)
        before = state(robot)
        ran = run("merge", other, "-C", robot)
        assert ran.status == 1
        assert reason in ran.out
        assert "Nothing was written." in ran.out
        assert state(robot) == before
        document = json.loads(run("merge", other, "-C", robot, "--format", "json").out)
        schema = json.loads(resources.resource_path("schemas", "merges.schema.json").read_text(encoding="utf-8"))
        jsonschema_rs.validate(schema, document)
        assert document["written"] is False
        settled = run("merge", other, "-C", robot, "--unsettled")
        assert settled.status == 1
        assert state(robot) != before
        is_marked = "<<<<<<<" in "".join(state(robot))
        assert is_marked == ("UU" in repositories.git(robot, "status", "--porcelain"))
        repositories.git(robot, "merge", "--abort")
        assert state(robot) == before


def test_a_work_tree_that_is_not_ready_is_left_as_it_is(run: Run, robot: Path) -> None:
    commit_branch(robot, "edited", GRAPH)

    def refused(reason: str, branch: str = "edited") -> None:
        before = state(robot)
        ran = run("merge", branch, "-C", robot)
        assert (ran.status, state(robot)) == (2, before)
        assert reason in ran.err

    (robot / "README").write_text("changed\n")
    refused("`README` has changes that are not committed: `git commit` or `git stash` them first")
    repositories.git(robot, "checkout", "README")
    (robot / "groups/log.yaml").write_text("groups: {}\n")
    refused("groups/log.yaml")  # in the way, and nobody's
    (robot / "groups/log.yaml").unlink()
    refused("there is no revision `nowhere`", "nowhere")
    assert run("merge", "edited", "-C", robot).status == 0
    refused("a merge is under way: `git merge --abort` or `git commit` ends it")
    repositories.git(robot, "merge", "--abort")
    repositories.git(robot, "checkout", "-q", "--orphan", "stranger")
    repositories.commit(robot, {"README": "x"})
    refused("refusing to merge unrelated histories", "main")


def test_lines_that_were_merged_crosswise_are_left_to_git(run: Run, robot: Path) -> None:
    commit_branch(robot, "one", {"README": "one\n"})
    commit_branch(robot, "two", {"NOTES": "two\n"})
    for name, other in (("one", "two"), ("two", "one~2")):
        repositories.git(robot, "checkout", "-q", name)
        repositories.git(robot, "merge", "-q", "--no-ff", "--no-edit", other)
        repositories.commit(robot, {f"{name}.txt": name})
    ran = run("merge", "one", "-C", robot)
    assert (ran.status, "crosswise" in ran.err) == (2, True)
