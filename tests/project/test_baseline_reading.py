"""Tests of reading a baseline: what is wrong with it is said at its place."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.pipeline import index_all_rules
from archgen.project import baseline_reading


def _read(folder: Path, text: str | bytes) -> tuple[list[str], list[str]]:
    file = folder / "b.yaml"
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    _, known, found = baseline_reading.read_baseline(file, "x/b.yaml", index_all_rules())
    entries = [f"{k.rule} {k.element}: {k.message} x{k.occurrences} at {k.span}" for k in known]
    return entries, [f"{d.span} {d.rule}: {d.message} | {d.help}" for d in found]


def test_entries_are_read_with_their_places(tmp_path: Path) -> None:
    text = "archgen_baseline: 1\nfindings:\n  - {rule: unread-output, element: g.c, message: no, count: 2}\n"
    assert _read(tmp_path, text) == (["unread-output g.c: no x2 at x/b.yaml:3:6"], [])


def test_one_that_knows_nothing(tmp_path: Path) -> None:
    for findings in ("[]", "", "~"):
        assert _read(tmp_path, f"archgen_baseline: 1\nfindings: {findings}\n") == ([], [])


@pytest.mark.parametrize(
    ("entry", "said"),
    [
        ("{rule: unread-output}", "3:5 missing-key: this finding has no `message`"),
        ("{message: m}", "3:5 missing-key: this finding has no `rule`"),
        ("{rule: unread-output, message: [m]}", "3:36 wrong-value: `message` takes text"),
        (
            "{rule: unread-output, message: m, count: 0}",
            "3:46 wrong-value: `count` takes a whole number from 1 to 1000000",
        ),
        (
            "{rule: unread-output, message: m, count: true}",
            "3:46 wrong-value: `count` takes a whole number from 1 to 1000000",
        ),
        (
            "{rule: unread-output, message: m, count: 1e99}",
            "3:46 wrong-value: `count` takes a whole number from 1 to 1000000",
        ),
        ("{rule: unread-output, message: m, line: 4}", "3:39 unknown-key: a baseline has no key `line` here"),
        ("{rule: unread-outputs, message: m}", "3:12 unknown-rule: there is no rule `unread-outputs`"),
        ("just text", "3:5 wrong-value: a finding takes the keys rule, element and message"),
    ],
)
def test_an_entry_that_cannot_be_used_is_said_and_the_others_are_used(entry: str, said: str, tmp_path: Path) -> None:
    good = "{rule: unfed-input, message: m}"
    known, found = _read(tmp_path, f"archgen_baseline: 1\nfindings:\n  - {entry}\n  - {good}\n")
    assert known == ["unfed-input : m x1 at x/b.yaml:4:6"]
    assert [line.partition(" | ")[0] for line in found] == [f"x/b.yaml:{said}"]


def test_what_cannot_be_known_in_advance(tmp_path: Path) -> None:
    text = "archgen_baseline: 1\nfindings:\n- {rule: syntax-error, message: m}\n"
    assert _read(tmp_path, text) == (
        [],
        [
            (
                "x/b.yaml:3:10 unknown-rule: `syntax-error` cannot be known in advance: what comes after reading and linking"
                " rests on it | mend what it reports, and take the entry out"
            )
        ],
    )


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("archgen: 1\n", "1:1 wrong-value: this is no baseline: it does not say `archgen_baseline: 1`"),
        ("archgen_baseline: 2\n", "1:19 wrong-value: this is no baseline: it does not say `archgen_baseline: 1`"),
        ("archgen_baseline: 1\nfindings: {a: 1}\n", "2:11 wrong-value: `findings` takes a list"),
        ("archgen_baseline: 1\nfindings: [\n", "2:12 syntax-error: the text ends where a value should stand"),
        ("archgen_baseline: 1\nfindngs: []\n", "2:1 unknown-key: a baseline has no key `findngs` here"),
        (b"archgen_baseline: 1\n\xff\n", "2:1 syntax-error: the byte 0xFF is not UTF-8"),
        ("archgen_baseline: 1\nx: &a [*a]\n", "2:8 recursive-alias: `*a` stands inside of what it stands for"),
        (
            "<<<<<<< a\narchgen_baseline: 1\n=======\n>>>>>>> b\n",
            "1:1 merge-conflict: Git could not merge `a` with `b` here",
        ),
    ],
)
def test_a_file_that_cannot_be_used_knows_nothing(text: str | bytes, said: str, tmp_path: Path) -> None:
    known, found = _read(tmp_path, text)
    assert (known, [line.partition(" | ")[0] for line in found][:1]) == ([], [f"x/b.yaml:{said}"])


def test_a_folder_is_no_file(tmp_path: Path) -> None:
    (tmp_path / "b.yaml").mkdir()
    _, known, found = baseline_reading.read_baseline(tmp_path / "b.yaml", "b.yaml", index_all_rules())
    assert (known, [d.message for d in found]) == ((), ["this is a folder, not a file"])


def test_which_texts_were_baselines() -> None:
    assert baseline_reading.is_baseline("<<<<<<< a\narchgen_baseline: 1\n")
    assert not baseline_reading.is_baseline("x: {archgen_baseline: 1}\n")
