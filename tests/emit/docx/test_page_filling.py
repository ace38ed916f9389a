"""Pages of a report filled to their foot: pictures drawn smaller, or behind their table."""

from __future__ import annotations

from dataclasses import replace

import pytest

from archgen.emit.docx.page_flow import FlowPiece, PaperSheet, ScalablePicture, fill_pages

_SHEET = PaperSheet(400, 1000, 0, 0, 0, 0)
"""A page of 1000 points."""


def _create_text(name: str, height: float, *, keep_next: bool = False, new_page: bool = False) -> FlowPiece:
    return FlowPiece(name, (height,), keep_next=keep_next, whole=True, sheet=_SHEET, new_page=new_page)


def _create_picture(height: float, least: float) -> FlowPiece:
    def draw_piece(share: float) -> FlowPiece:
        piece = FlowPiece(f"picture {share:.2f}", (height * share,), keep_next=True, sheet=_SHEET)
        return replace(piece, picture=picture)

    picture = ScalablePicture(height, least, draw_piece)
    return draw_piece(1.0)


def _create_figure(height: float, least: float) -> list[FlowPiece]:
    caption = FlowPiece("figure title", (20,), sheet=_SHEET, captions="Figure")
    return [_create_text("lead", 20, keep_next=True), _create_picture(height, least), caption]


def _create_table(height: float) -> list[FlowPiece]:
    caption = FlowPiece("table title", (20,), keep_next=True, sheet=_SHEET, captions="Table")
    return [caption, FlowPiece("<w:tbl>", (40, *[20.0] * round((height - 40) / 20)), sheet=_SHEET)]


def _list_names(pieces: list[FlowPiece]) -> list[str]:
    return [piece.xml for piece in fill_pages(pieces, _SHEET)]


@pytest.mark.parametrize(
    ("text_height", "picture_name"),
    [
        (500, "picture 1.00"),  # it fits as it is
        (600, "picture 0.89"),  # 360 are free, 6 of them stay so
        (680, "picture 0.69"),  # 280 are free
        (710, "picture 1.00"),  # it would be too small to read
    ],
)
def test_a_picture_that_does_not_fit_is_drawn_smaller_as_long_as_it_can_be_read(
    text_height: int, picture_name: str
) -> None:
    names = _list_names([_create_text("text", text_height, new_page=True), *_create_figure(400, 0.65)])

    assert names == ["text", "lead", picture_name, "figure title"]


def test_a_tall_picture_changes_places_with_its_table() -> None:
    text = _create_text("text", 500, new_page=True)

    names = _list_names([text, *_create_figure(800, 0.7), *_create_table(200), _create_text("end", 20)])

    assert names == ["text", "lead", "table title", "<w:tbl>", "picture 1.00", "figure title", "end"]


def test_a_tall_picture_stays_before_its_table_where_little_is_empty_above_it() -> None:
    text = _create_text("text", 900, new_page=True)

    names = _list_names([text, *_create_figure(800, 0.7), *_create_table(60)])

    assert names == ["text", "lead", "picture 1.00", "figure title", "table title", "<w:tbl>"]


def test_a_tall_picture_stays_before_the_heading_and_the_facts_that_follow() -> None:
    heading = FlowPiece("heading", (20,), keep_next=True, sheet=_SHEET, marks=("next",))
    facts = FlowPiece("<w:tbl>", (60,), sheet=_SHEET)

    names = _list_names([_create_text("text", 500, new_page=True), *_create_figure(800, 0.7), heading, facts])

    assert names == ["text", "lead", "picture 1.00", "figure title", "heading", "<w:tbl>"]


def test_all_pictures_of_a_chapter_are_a_little_smaller_where_that_saves_its_last_page() -> None:
    figure = [*_create_figure(400, 0.7)]

    names = _list_names([_create_text("text", 100, new_page=True), *figure, *figure, _create_text("end", 30)])

    # Of 1,000 points texts and captions need 210; the pictures need 800.
    assert names[2] == names[5] == "picture 0.96"


def test_a_picture_on_a_turned_page_stays_as_it_is() -> None:
    wide = replace(_SHEET, width=1000, height=400)
    pieces = [replace(piece, sheet=wide) for piece in _create_figure(300, 0.5)]

    names = _list_names([_create_text("text", 900, new_page=True), *pieces])

    assert names == ["text", "lead", "picture 1.00", "figure title"]
