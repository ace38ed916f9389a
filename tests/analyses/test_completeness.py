"""Tests of the note on what is still blank."""

from __future__ import annotations

from collections.abc import Callable

from archgen.analyses.completeness import missing_detail

Found = Callable[..., list[str]]


def test_one_note_lists_all_that_a_component_lacks(found: Found) -> None:
    text = """
        partner certh
        component a.stub
        component a.lidar role=source owner=certh functionality=Measures requirements=
        out a.lidar.scan
        out a.lidar.cloud
        node lidar implements=a.lidar timed=a.lidar
    """
    assert found(missing_detail, text) == [
        "2: `a.stub` still lacks functionality, owner, requirements, inputs, outputs, performance and timing",
        "3: `a.lidar` still lacks the type of `scan` and `cloud` and performance",
    ]
