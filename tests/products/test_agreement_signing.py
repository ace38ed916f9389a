"""Signing: which commit, which versions, and the file that records them."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import pipeline
from archgen.emit import file_tree
from archgen.emit.file_tree import OutputError
from archgen.git import GitError
from archgen.products.agreement_documents import make_project_agreement
from archgen.products.agreement_signing import PreparedSignature, SigningError, prepare_signature, record_signature
from tests.cli.test_signed_agreements import ROBOT
from tests.repositories import commit, git, repository

FILE = "agreements/a-b.yaml"


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    root = repository(tmp_path, {"archgen.yaml": ROBOT})
    git(root, "config", "user.name", "Clerk")
    git(root, "config", "user.email", "clerk@x.org")
    return root


def prepare(root: Path, day: str = "2026-03-01", **signers: str) -> PreparedSignature:
    project = pipeline.check_project(root)
    records = make_project_agreement(project, "a", "b").content.records
    return prepare_signature(project, ("a", "b"), records, signers or {"a": "Ada", "b": "Ben"}, day)


def record(root: Path, prepared: PreparedSignature) -> str:
    record_signature(pipeline.check_project(root), prepared)
    return (root / FILE).read_text(encoding="utf-8")


def test_what_is_signed_is_the_last_commit(robot: Path) -> None:
    prepared = prepare(robot, a="Ada “L”", b="Ben")
    text = record(robot, prepared)
    head = git(robot, "rev-parse", "HEAD")
    lines = text.splitlines()
    assert lines[:8] == [
        "# What two partners agreed on. `archgen sign` writes `signed`: edits of it by hand are found.",
        "agreements:",
        "  a-b:",
        "    signed:",
        "      rules: 2",
        "      tag: signed/a-b/2026-03-01",
        f'      revision: "{head}"',
        f'      terms: "{prepared.agreement.hash_terms()}"',
    ]
    assert lines[8:11] == ["      by:", '        a: "Ada “L”, 2026-03-01"', '        b: "Ben, 2026-03-01"']
    assert [line.split('"')[0] for line in lines[11:]] == [
        "      versions:",
        "        a:",
        "          sense.bell.alarm: ",
        "          sense.eye.stop: ",
        "          sense.lidar.scan: ",
    ]
    assert (
        git(robot, "tag", "-n") == "signed/a-b/2026-03-01 Signed for Alpha: Ada “L”, 2026-03-01; Beta: Ben, 2026-03-01"
    )
    assert git(robot, "rev-parse", "signed/a-b/2026-03-01^{commit}") == head
    (agreement,) = pipeline.check_project(robot).architecture.agreements.values()
    assert agreement == prepared.agreement


def test_all_else_in_the_file_stays_as_it_is(robot: Path) -> None:
    before = "# Ours.\nagreements:\n   a-b:\n      # As always.\n      terms: {notice: 30 days}"
    commit(robot, {FILE: before})
    text = record(robot, prepare(robot))
    assert text.startswith(f"{before}\n      signed:\n        rules: 2\n")
    commit(robot, {FILE: text})
    again = record(robot, prepare(robot))
    assert again.startswith(f"{before}\n      signed:\n")
    assert again.count("signed:") == 1
    assert "signed/a-b/2026-03-01.2" in again


@pytest.mark.parametrize(
    "text",
    [
        "agreements: {a-b: {terms: {notice: 30 days}}}\n",
        "agreements:\n  a-b:\n    signed: {rules: 1}\n    terms: {notice: 3}\n",
    ],
)
def test_a_form_that_cannot_be_extended_is_refused(robot: Path, text: str) -> None:
    commit(robot, {FILE: text})
    with pytest.raises(SigningError, match="in block form, with nothing behind `signed`"):
        prepare(robot)


@pytest.mark.parametrize("edit", ["change", "new file", "removed"])
def test_what_is_not_committed_is_not_signed(robot: Path, edit: str) -> None:
    commit(robot, {"more.yaml": "hosts: {box: {cores: 2}}\n"})
    if edit == "removed":
        (robot / "more.yaml").unlink()
    else:
        (robot / ("more.yaml" if edit == "change" else "other.yaml")).write_text("hosts: {bax: }\n", encoding="utf-8")
    with pytest.raises(SigningError, match="is not as it was committed: what is signed is a commit, so commit first"):
        prepare(robot)


def test_signatures_of_other_pairs_may_wait(robot: Path) -> None:
    (robot / "agreements").mkdir()
    (robot / "agreements" / "a-c.yaml").write_text("agreements: {a-c: {}}\n", encoding="utf-8")
    prepare(robot)


def test_one_now_and_the_other_one_later(robot: Path) -> None:
    first = prepare(robot, a="Ada")
    assert first.missing_partners == ("b",)
    commit(robot, {FILE: record(robot, first), "note.md": "x"})
    second = prepare(robot, "2026-03-05", b="Ben")
    assert second.missing_partners == ()
    assert second.signature.revision == first.signature.revision
    assert second.signature.by == {"a": "Ada, 2026-03-01", "b": "Ben, 2026-03-05"}
    commit(robot, {"archgen.yaml": ROBOT.replace("rate: 10 Hz", "rate: 8 Hz")})
    with pytest.raises(SigningError, match="`a` signed something else at `signed/a-b/2026-03-01`: sign it there"):
        prepare(robot, "2026-03-06", b="Ben")
    assert prepare(robot, "2026-03-06").signature.revision == git(robot, "rev-parse", "HEAD")


def test_who_signs_is_one_of_the_two(robot: Path) -> None:
    with pytest.raises(SigningError, match="`c` is none of the two partners `a` and `b`"):
        prepare(robot, c="Cleo")


def test_an_agreement_in_another_file_is_not_signed(robot: Path) -> None:
    commit(robot, {"other.yaml": "agreements:\n  a-b:\n    terms: {notice: none}\n"})
    with pytest.raises(SigningError, match=r"`a-b` stands at other.yaml:2:3: move it into `agreements/a-b.yaml`"):
        prepare(robot)


def test_what_git_refuses_is_told(robot: Path) -> None:
    prepared = prepare(robot)
    git(robot, "tag", "signed/a-b/2026-03-01")
    with pytest.raises(GitError, match=r"git makes no tag `signed/a-b/2026-03-01`: tag .* already exists"):
        record_signature(pipeline.check_project(robot), prepared)
    assert not (robot / FILE).exists()


def test_a_file_that_cannot_be_written_leaves_no_tag(robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        message = "No space left on device"
        raise OutputError(message)

    prepared = prepare(robot)
    monkeypatch.setattr(file_tree, "write_file", fail)
    with pytest.raises(OutputError):
        record_signature(pipeline.check_project(robot), prepared)
    assert git(robot, "tag") == ""


def test_an_interrupt_after_all_was_written_leaves_the_tag(robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def write(path: Path, data: bytes) -> None:
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(data)
        raise KeyboardInterrupt

    prepared = prepare(robot)
    monkeypatch.setattr(file_tree, "write_file", write)
    with pytest.raises(KeyboardInterrupt):
        record_signature(pipeline.check_project(robot), prepared)
    assert git(robot, "tag") == "signed/a-b/2026-03-01"
