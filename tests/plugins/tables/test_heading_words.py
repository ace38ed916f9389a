"""The words that head columns, in each language."""

from __future__ import annotations

import pytest

from archgen.plugins.tables.table_cells import HEADING_WORDS, KEY_BY_HEADING, TARGETS, fold_heading, key_of_heading

SPELLINGS = [
    (language, key, word.strip())
    for language, words_by_key in HEADING_WORDS.items()
    for key, words in words_by_key.items()
    for word in words.split(";")
]


@pytest.mark.parametrize("language", HEADING_WORDS)
def test_every_language_has_every_heading(language: str) -> None:
    assert tuple(HEADING_WORDS[language]) == TARGETS
    assert all(word.strip() for words in HEADING_WORDS[language].values() for word in words.split(";"))


def test_no_word_means_two_things() -> None:
    assert [
        (language, key, word) for language, key, word in SPELLINGS if KEY_BY_HEADING[fold_heading(word)] != key
    ] == []


@pytest.mark.parametrize(
    ("heading", "key"),
    [
        ("AUSGÄNGE", "output"),
        ("Ausgaenge", "output"),
        ("Ausgange", "output"),
        ("Entre\u0301es", "input"),
        ("Sous-Système", "group"),
        ("Sous Systeme", "group"),
        ("sub-systems", "group"),
        ("Tasa [Hz]", "rate"),
        ("Zykluszeit in ms", "period"),
        ("Fréquence (Hz)", "rate"),
        ("update rate / Hz", "rate"),
        ("Nœud ROS", "node"),
        ("Noeud ROS", "node"),
        ("Señales", "signal"),
        ("Komponente / Component", "component"),
        ("Entrée(s)", "input"),
        ("Ein-/Ausgang", None),
        ("Preis", None),
        ("", None),
    ],
)
def test_a_heading_is_known_in_any_spelling(heading: str, key: str | None) -> None:
    assert key_of_heading(heading) == key
