"""The deadline of a chain in all its forms: always, shares of the reactions, and what cannot be asked."""

from __future__ import annotations

import pytest

from archgen.diagnostics.diagnostic import Severity
from archgen.link.declare.timing_declaration import ALWAYS
from tests.judged_projects import check_text
from tests.timing.random_systems import architecture

HEAD = """groups: {g: {components: {a: {outputs: {o: T}}, b: {inputs: {i: g.a.o}}}}}
chains:
  c:
    through: [g.a, g.b]
    deadline: """


def _read(deadline: str) -> tuple[str | None, dict[str, str]]:
    chain = architecture(HEAD + deadline + "\n").chains["c"]
    return str(chain.deadline) if chain.deadline else None, {
        name: str(limit) for name, limit in chain.deadline_shares.items()
    }


@pytest.mark.parametrize(
    ("deadline", "always", "shares"),
    [
        ("400 ms", "400 ms", {}),
        (f"{{{ALWAYS}: 400 ms}}", "400 ms", {}),
        ('{always: 400 ms, "95 %": 200 ms}', "400 ms", {"95 %": "200 ms"}),
        (
            "{99.90%: 300 ms, always: 1 s, 95 %: 200 ms, 5%: 1 ms}",
            "1 s",
            {"5 %": "1 ms", "95 %": "200 ms", "99.9 %": "300 ms"},
        ),
        ("{95 %: 200 ms}", None, {"95 %": "200 ms"}),
    ],
)
def test_forms(deadline: str, always: str | None, shares: dict[str, str]) -> None:
    assert _read(deadline) == (always, shares)


def test_all_of_it_is_told_in_one_line() -> None:
    assert architecture(HEAD + "{always: 1 s, 95%: 200 ms}\n").chains["c"].deadline_text == "1 s, 95 % in 200 ms"


@pytest.mark.parametrize(
    ("deadline", "place", "message"),
    [
        ("{100 %: 1 ms}", 16, "`100 %` cannot be a share"),
        ("{120 %: 1 ms}", 16, "`120 %` cannot be a share"),
        ("{-5 %: 1 ms}", 16, "`-5 %` cannot be a share"),
        ("{often: 1 ms}", 16, "`often` cannot be a share"),
        ("{0 %: 1 ms}", 16, "0 % of the reactions ask for nothing"),
        ("{95 %: 0 ms}", 22, "`95 %` cannot be zero"),
        ("{95 %: soon}", 22, "`95 %` cannot be `soon`"),
        (
            "{99.99999 %: 1 ms}",
            16,
            "no data can judge `99.99999 %`: fewer than one of a million reactions may be later",
        ),
        ("{always: 1 ms, 95 %: 2 ms}", 36, "`95 %` (2 ms) is above `always` (1 ms)"),
        ("{99 %: 1 ms, 95 %: 2 ms}", 34, "`95 %` (2 ms) is above `99 %` (1 ms)"),
        ("{95 %: 1 ms, 95.0%: 2 ms}", 28, "`95.0%` is written twice"),
        ("[1 ms]", 5, "`deadline` is a list, but must be text or a mapping"),
    ],
)
def test_what_cannot_be_asked_is_told_at_its_place(deadline: str, place: int, message: str) -> None:
    found = [
        (each.span.line, each.span.column, each.message)
        for each in check_text(HEAD + deadline + "\n")
        if each.severity is Severity.ERROR
    ]
    assert found == [(5, place, message)]


@pytest.mark.parametrize("key", ["1e5 %", "5/0 %", "% ", "%" * 500, "\u0665 %", "9" * 400 + " %"])
def test_a_strange_share_is_told(key: str) -> None:
    assert any("cannot be" in each.message for each in check_text(f'{HEAD}{{"{key}": 1 ms}}\n'))
