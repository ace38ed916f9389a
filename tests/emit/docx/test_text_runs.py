"""Runs of text in cells: names break between their words, and only where they are too wide."""

from __future__ import annotations

import pytest

from archgen.emit.docx.text_metrics import measure_code
from archgen.emit.docx.text_runs import RunSetting
from archgen.views.shapes import Text

NAME = "ramcip_msgs/msg/TrackedPeople"


@pytest.mark.parametrize("spare", [-1.0, 1.0])
def test_a_name_that_is_wider_than_its_cell_has_places_to_break(spare: float) -> None:
    # 1.0: it fits by itself, but not with the comma that follows it.
    setting = RunSetting(9, measure_code(NAME) * 9 + spare)
    assert setting.break_names(Text(NAME, code=True)) == "ramcip_\u200bmsgs/\u200bmsg/\u200bTrackedPeople"


def test_a_name_that_fits_is_left_whole() -> None:
    # Word finds a name by its letters only where nothing stands between them.
    setting = RunSetting(9, measure_code(NAME) * 9 + 9)
    assert setting.break_names(Text(NAME, code=True)) == NAME
