"""Runs of text in cells: names break between their words, and only where they are too wide."""

from __future__ import annotations

from archgen.emit.docx.text_pieces import RunSetting
from archgen.emit.text_metrics import measure_code, measure_word
from archgen.views.shapes import Text

NAME = Text("ramcip_msgs/msg/TrackedPeople", code=True)
BROKEN_NAME = "ramcip_\u200bmsgs/\u200bmsg/\u200bTrackedPeople"
NAME_WIDTH = measure_code(NAME.text) * 9


def test_a_name_that_is_wider_than_its_cell_has_places_to_break() -> None:
    assert RunSetting(9, NAME_WIDTH - 1).break_names([Text("reads "), NAME]) == ["reads ", BROKEN_NAME]


def test_a_comma_stays_with_its_name_and_counts() -> None:
    assert RunSetting(9, NAME_WIDTH + 1).break_names([NAME, Text(", more")])[0] == BROKEN_NAME


def test_a_name_that_fits_is_left_whole() -> None:
    # Word finds a name by its letters only where nothing stands between them.
    runs = [NAME, Text("of somebody else", line_break=True)]
    assert RunSetting(9, NAME_WIDTH + 1).break_names(runs) == [NAME.text, "of somebody else"]


def test_a_name_of_several_runs_is_one_word() -> None:
    runs = [Text("reads /reasoning/"), Text("communication_act", ref="port:x"), Text(" every 500 ms")]
    width = measure_word("/reasoning/communication_act") * 9
    assert RunSetting(9, width + 1).break_names(runs) == [run.text for run in runs]
    assert RunSetting(9, width - 1).break_names(runs) == [
        "reads /\u200breasoning/\u200b",
        "communication_\u200bact",
        " every 500 ms",
    ]


def test_figures_are_left_whole() -> None:
    assert RunSetting(9, 20).break_names([Text("≤ 1234.567\u202fms left")]) == ["≤ 1234.567\u202fms left"]
