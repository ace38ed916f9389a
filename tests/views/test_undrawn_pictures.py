"""What a page says in the place of a picture that is left out."""

from __future__ import annotations

from archgen.views.drawing_set import COMPONENT_KINDS, GROUP_KINDS
from archgen.views.pages.page_parts import keep_drawn, make_timing_note
from archgen.views.pages.report_outline import DocumentEdition
from archgen.views.shapes import Figure, Paragraph, Text


def test_a_picture_left_out_for_its_number_leaves_a_note_with_a_link_and_others_nothing() -> None:
    text = Paragraph((Text("Stays."),))
    figures = (Figure("figure:1", "components/g.a", "A", "A."), Figure("figure:2", "implementation/g.a", "A", "A."))
    kept = keep_drawn((text, *figures), DocumentEdition(undrawn_kinds=COMPONENT_KINDS))
    assert kept[0] is text
    (note,) = kept[1:]
    assert isinstance(note, Paragraph)
    assert [run.ref for run in note.inlines if run.ref] == ["page:explorer"]
    assert "archgen site --component-pictures" in [run.text for run in note.inlines]
    # Of another level, or outside of the selection: nothing is missing.
    assert keep_drawn((text, *figures), DocumentEdition()) == (text,)


def test_timing_of_groups_has_a_note_where_their_pictures_are_left_out() -> None:
    assert make_timing_note(DocumentEdition()) == ()
    (section,) = make_timing_note(DocumentEdition(undrawn_kinds=GROUP_KINDS))
    assert section.anchor == "timing:groups"
