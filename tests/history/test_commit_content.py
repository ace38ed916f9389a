"""When two versions of a project say the same."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.history.history_counting import CommitContents
from archgen.project import load_project

TEXT = "archgen: 1\ngroups: {a: {components: {b: {title: B}}}}\n"


def _says_the_same(folder: Path, first: str, second: str) -> bool:
    contents, keys = CommitContents(), []
    for text in (first, second):
        (folder / "archgen.yaml").write_text(text)
        keys.append(contents.content_key(load_project(folder)))
    return keys[0] == keys[1]


@pytest.mark.parametrize(
    ("second", "same"),
    [
        (TEXT, True),
        (f"# a comment\n\n{TEXT}", True),
        ("archgen: 1\ngroups:\n  a:\n    components:\n      b:\n        title: B\n", True),
        (TEXT.replace("title: B", "title: C"), False),
        (TEXT.replace("title: B", "title: '1'"), False),
        (TEXT.replace("b:", "c:"), False),
        (f"{TEXT}nodes: {{n: }}\n", False),
        (f"{TEXT}groups: [\n", False),
    ],
)
def test_places_and_comments_are_nothing_and_words_everything(tmp_path: Path, second: str, same: bool) -> None:  # noqa: FBT001
    assert _says_the_same(tmp_path, TEXT, second) is same


def test_a_number_and_the_same_text_in_quotes_differ(tmp_path: Path) -> None:
    assert not _says_the_same(tmp_path, TEXT.replace("title: B", "title: 1"), TEXT.replace("title: B", "title: '1'"))


def test_where_a_comment_silences_a_finding_its_line_matters(tmp_path: Path) -> None:
    silenced = f"{TEXT}# archgen: ignore[empty-group] later\n"
    assert not _says_the_same(tmp_path, silenced, f"\n{silenced}")
