"""`archgen new`: the right file, the right form, nothing else changed; refusals that say what to do."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from archgen.pipeline import check_project
from tests.cli.conftest import Run
from tests.running import RAMCIP, contents


@pytest.fixture
def ramcip(tmp_path: Path) -> Path:
    """Give a copy of the case study."""
    shutil.copytree(RAMCIP, tmp_path / "ramcip", ignore=shutil.ignore_patterns("archgen-out"))
    return tmp_path / "ramcip"


def changed(before: dict[str, bytes], folder: Path) -> dict[str, str]:
    """Give the lines that were added, by file; that others are as they were is asserted."""
    found = {}
    for file, data in contents(folder).items():
        if data == before.get(file):
            continue
        old, new = before.get(file, b"").decode().splitlines(), data.decode().splitlines()
        start = next((n for n, pair in enumerate(zip(old, new, strict=False)) if pair[0] != pair[1]), len(old))
        count = len(new) - len(old)
        assert new[:start] + new[start + count :] == old
        found[file] = "\n".join(new[start : start + count])
    assert before.keys() <= contents(folder).keys()
    return found


def test_a_component_goes_where_its_group_is_told(run: Run, ramcip: Path) -> None:
    before = contents(ramcip)
    ran = run("new", "component", "human_state.gaze", "--owner", "tum", "--role", "filter", "-C", ramcip)
    assert (ran.status, ran.err) == (0, "")
    added = changed(before, ramcip)
    assert list(added) == ["groups/human_state.yaml"]
    assert added["groups/human_state.yaml"].strip("\n") == (
        "      gaze:\n        title: Gaze\n        owner: tum\n        role: filter\n"
        "        functionality:  # what it does, in a sentence or two\n"
        "        inputs:  # id: component.output\n        outputs:  # id: conceptual type"
    )
    line = (ramcip / "groups/human_state.yaml").read_text(encoding="utf-8").splitlines().index("      gaze:") + 1
    assert f"human_state.yaml (`human_state.gaze` at line {line})" in ran.out
    assert check_project(ramcip).architecture.components["human_state.gaze"].owner == "tum"


@pytest.mark.slow
def test_a_group_gets_a_file_beside_the_others(run: Run, ramcip: Path) -> None:
    before = contents(ramcip)
    assert run("new", "group", "garden", "--title", "Garden: outside", "--owner", "ace", "-C", ramcip).status == 0
    assert changed(before, ramcip) == {
        "groups/garden.yaml": 'groups:\n  garden:\n    title: "Garden: outside"\n    owner: ace\n'
        "    description:  # what the group is for\n    components:  # `archgen new component` adds one"
    }
    assert run("new", "component", "gate", "--group", "garden", "-C", ramcip).status == 0
    assert [d.rule for d in check_project(ramcip).findings if d.severity == "error"] == []


def test_a_node_goes_to_those_of_its_component(run: Run, ramcip: Path) -> None:
    before = contents(ramcip)
    words = ("--implements", "skeleton_tracking", "--package", "gaze", "--status", "adapted")
    assert run("new", "node", "gaze_tracker", *words, "-C", ramcip).status == 0
    assert {file: text.strip("\n") for file, text in changed(before, ramcip).items()} == {
        "nodes/perception.yaml": "  gaze_tracker:\n    implements: skeleton_tracking\n    package: gaze\n    status: adapted"
    }


def test_a_project_in_one_file_stays_one(run: Run, first: Path) -> None:
    for words in (("group", "arm"), ("component", "arm.hand"), ("node", "hand_driver", "--implements", "hand")):
        assert run("new", *words, "-C", first).status == 0
    assert list(contents(first)) == ["archgen.yaml"]
    found = check_project(first)
    assert found.architecture.nodes["hand_driver"].implements == ("arm.hand",)
    assert not found.has_errors


def test_where_nodes_stand_beside_their_groups_a_new_one_does(run: Run, tmp_path: Path) -> None:
    assert run("init", tmp_path / "r").status == 0
    for words in (("group", "arm"), ("component", "arm.hand"), ("node", "hand_driver", "--implements", "hand")):
        assert run("new", *words, "-C", tmp_path / "r").status == 0
    assert (tmp_path / "r/groups/arm.yaml").read_text(encoding="utf-8") == (
        "# yaml-language-server: $schema=../.vscode/archgen.schema.json\n"
        "groups:\n  arm:\n    title: Arm\n    description:  # what the group is for\n"
        "    components:  # `archgen new component` adds one\n"
        "      hand:\n        title: Hand\n        functionality:  # what it does, in a sentence or two\n"
        "        inputs:  # id: component.output\n        outputs:  # id: conceptual type\n"
        "nodes:\n  hand_driver:\n    implements: hand\n    status: planned\n"
    )


def test_dry_run_prints_the_difference_and_writes_nothing(run: Run, first: Path) -> None:
    before = contents(first)
    ran = run("new", "node", "second_lidar", "--implements", "lidar", "--dry-run", "-C", first)
    assert ran.out.startswith("--- a/archgen.yaml\n+++ b/archgen.yaml\n@@ ")
    assert "\n+  second_lidar:\n+    implements: lidar\n+    status: planned\n" in ran.out
    assert contents(first) == before


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (
            ("component", "devices.Lidar2"),
            "'Lidar2' is no id: lower-case words joined by '_', at most 64 characters; write 'lidar2'",
        ),
        (("component", "devices.lidar"), "there is a component 'lidar' already: archgen.yaml:25:7"),
        (("group", "devices"), "there is a group 'devices' already: archgen.yaml:21:3"),
        (("node", "amcl"), "there is a node 'amcl' already: archgen.yaml:168:3"),
        (("component", "arm"), "say in which group with --group: devices, navigation, service"),
        (("component", "device.arm"), "there is no group 'device'; did you mean `devices`?"),
        (("component", "a.arm", "--group", "b"), "'a.arm' is in the group 'a', and --group says 'b'"),
        (
            ("group", "true"),
            "'true' is no id: lower-case words joined by '_', at most 64 characters; write 'group_true'",
        ),
    ],
)
def test_wrong_ids(words: tuple[str, ...], said: str, run: Run, first: Path) -> None:
    before = contents(first)
    ran = run("new", *words, "-C", first)
    assert ran.status == 2
    assert ran.err.endswith(f"Error: {said}\n")
    assert contents(first) == before


def test_what_would_be_an_error_is_shown_and_not_written(run: Run, first: Path) -> None:
    before = contents(first)
    ran = run("new", "node", "x", "--implements", "lidr", "--host", "pc", "-C", first)
    assert ran.status == 2
    assert "error[unknown-reference]: no component named `lidr`" in ran.err
    assert "did you mean `lidar`?" in ran.err
    assert "nothing was written" in ran.err
    assert contents(first) == before


def test_what_would_change_another_reference_is_not_written(run: Run, tmp_path: Path) -> None:
    text = (
        "archgen: 1\ngroups:\n  a:\n    components:\n      cam: {outputs: {image: Colour image}}\n"
        "  b:\n    components:\n      show: {inputs: {image: cam}}\n"
    )
    file = tmp_path / "robot.yaml"
    file.write_text(text, encoding="utf-8")
    ran = run("new", "component", "b.cam", "-C", file)
    assert ran.status == 2
    assert "`b.show`" in ran.err or "a.cam.image -> b.show.image" in ran.err
    assert file.read_text(encoding="utf-8") == text


def test_a_short_form_is_refused_with_what_to_write(run: Run, tmp_path: Path) -> None:
    file = tmp_path / "robot.yaml"
    file.write_text("archgen: 1\ngroups: {a: Group A}\n", encoding="utf-8")
    ran = run("new", "component", "a.b", "-C", file)
    assert ran.status == 2
    assert (
        "nothing was written\nWrite it by hand into robot.yaml, or into a file of its own:\n\n    groups:\n      a:\n"
        in ran.err
    )


def test_a_byte_order_mark_and_the_file_s_rights_stay(run: Run, first: Path) -> None:
    file = first / "archgen.yaml"
    data = b"\xef\xbb\xbf" + file.read_bytes().replace(b"\n", b"\r\n")
    file.write_bytes(data)
    file.chmod(0o640)
    assert run("new", "component", "service.bell", "-C", first).status == 0
    now = file.read_bytes()
    start = now.index(b"      bell:")
    assert now[:start].startswith(b"\xef\xbb\xbf# A small robot")
    assert b"\n" not in now.replace(b"\r\n", b"")
    assert file.stat().st_mode & 0o777 == 0o640


def test_sources_that_do_not_name_the_new_file(run: Run, ramcip: Path) -> None:
    file = ramcip / "archgen.yaml"
    listed = ", ".join(f"groups/{path.name}" for path in sorted((ramcip / "groups").iterdir()))
    file.write_text(
        file.read_text(encoding="utf-8").replace(
            '  - "groups/*.yaml"', "\n".join(f"  - {name}" for name in listed.split(", "))
        ),
        encoding="utf-8",
    )
    ran = run("new", "group", "garden", "-C", ramcip)
    assert (
        ran.err
        == "Error: `sources` of archgen.yaml has no pattern for groups/garden.yaml: add `groups/*.yaml` there first\n"
    )
    assert not (ramcip / "groups/garden.yaml").exists()


@pytest.mark.slow
def test_a_partner_gets_a_file_for_its_agreements_that_is_read_whatever_sources_names(run: Run, ramcip: Path) -> None:
    before = contents(ramcip)
    ran = run("new", "partner", "inria", "--title", "Inria: Nancy", "--reviewers", "@inria/nancy", "-C", ramcip)
    assert (ran.status, ran.err) == (0, "")
    assert "`archgen owners --format codeowners` makes CODEOWNERS anew" in ran.out
    added = changed(before, ramcip)
    assert added["archgen.yaml"] == '  inria:\n    title: "Inria: Nancy"\n    reviewers: "@inria/nancy"'
    assert added["review/inria.yaml"].startswith("# What Inria: Nancy agrees on. ")
    assert added["review/inria.yaml"].endswith("\nreview:\n  accepted:")
    assert [finding for finding in check_project(ramcip).findings if "inria" in str(finding)] == []
    with (ramcip / "review/inria.yaml").open("a", encoding="utf-8") as stream:
        stream.write("    human_state: {key: removed, reason: it did not help}\n")
    assert [entry.partner for entry in check_project(ramcip).architecture.review.accepted] == ["inria"]


def test_a_partner_of_a_single_file_gets_no_other_file(run: Run, tmp_path: Path) -> None:
    (tmp_path / "robot.yaml").write_text("archgen: 1\n")
    assert run("new", "partner", "a", "-C", tmp_path / "robot.yaml").status == 0
    assert list(contents(tmp_path)) == ["robot.yaml"]
    again = run("new", "partner", "a", "-C", tmp_path / "robot.yaml")
    assert (again.status, "there is a partner 'a' already" in again.err) == (2, True)
