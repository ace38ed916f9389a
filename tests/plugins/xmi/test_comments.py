"""What a comment of a UML model says, with the HTML of its editor taken off."""

from __future__ import annotations

import pytest

from archgen.plugins.xmi.uml_catalogue import make_plain


@pytest.mark.parametrize(
    ("written", "plain"),
    [
        (" Turns the wheels. \r\nSlowly.\r", "Turns the wheels. \nSlowly."),
        # What only looks like a tag is text.
        ("a < b and <c>", "a < b and <c>"),
        ("<p>Turns the\nwheels &amp; brakes.</p><p>Slowly.</p>", "Turns the wheels & brakes.\n\nSlowly."),
        ("<html><head><title>T</title><style>p {}</style></head><body>One<br/>two</body></html>", "One\ntwo"),
        ("<p>It has</p><ul><li>a wheel</li><li>a brake</li></ul>", "It has\n\n- a wheel\n- a brake"),
        ("<table><tr><td>a</td></tr><tr><td>b</td></tr></table>", "a\nb"),
        # An end without its beginning hides nothing.
        ("<p></style>Seen</p>", "Seen"),
    ],
)
def test_a_reader_of_the_page_sees_the_same(written: str, plain: str) -> None:
    assert make_plain(written) == plain
