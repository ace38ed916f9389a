"""Tests of the selectors in views and policies: what is wrong with them, and where."""

from __future__ import annotations

from tests.judged_projects import check_text

_ROBOT = """\
groups:
  sensing:
    components:
      camera: {outputs: {image: sensor_msgs/msg/Image}}
      screen: {inputs: {image: camera.image}}
"""


def _found(views: str) -> list[str]:
    rules = {"wrong-selector", "empty-view"}
    found = [d for d in check_text(f"{_ROBOT}{views}\n") if d.rule in rules]
    return [f"{d.span.line}:{d.span.column}-{d.span.end_column} {d.severity}[{d.rule}] {d.message}" for d in found]


def test_a_path_that_names_nothing_is_an_error_where_it_stands() -> None:
    assert _found("views: {a: camera+1 camra, b: 'lens camera'}") == [
        "6:21-26 error[wrong-selector] in the selector of the view `a`: nothing is called `camra`",
        "6:32-36 error[wrong-selector] in the selector of the view `b`: nothing is called `lens`",
    ]


def test_a_key_or_wildcard_that_nothing_fits_is_a_warning() -> None:
    assert _found('views: {a: {show: "tag:safety cam*a x*"}}') == [
        "6:20-30 warning[wrong-selector] in the selector of the view `a`: nothing has `tag:safety`",
        "6:37-39 warning[wrong-selector] in the selector of the view `a`: nothing fits `x*`",
    ]


def test_what_was_found_is_known_only_later() -> None:
    assert _found('views: {a: {show: "camera finding:unread-output"}}') == []


def test_a_policy_is_judged_like_a_view() -> None:
    assert _found('policies: {p: {forbid: {from: camera, to: "x,y"}}}') == [
        "6:45-46 error[wrong-selector] in the selector of the policy `p`: `,` is reserved; words are separated by blanks"
    ]


def test_a_view_of_nothing_is_empty() -> None:
    assert _found("views: {a: camera -camera, b: screen..camera, c: -screen}") == [
        "6:12-26 warning[empty-view] the view `a` shows nothing",
        "6:31-45 warning[empty-view] the view `b` shows nothing",
    ]
