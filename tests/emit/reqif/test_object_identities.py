"""Identifiers of other tools are given back, unless they are none or another object has them."""

from __future__ import annotations

from dataclasses import replace

from archgen.emit.reqif.reqif_writer import assign_identifiers
from archgen.views.requirement_exchange import ExchangedRequirement

_PLAIN = ExchangedRequirement("R-0", "T", "", "", "", "", "", (), (), (), (), "", "open")


def assign(*foreign: str) -> list[str]:
    requirements = [replace(_PLAIN, id=f"R-{n}", foreign_identifier=each) for n, each in enumerate(foreign, start=1)]
    return list(assign_identifiers(requirements).values())


def test_identifiers_of_other_tools_stay() -> None:
    assert assign("_5f3a", "GUID-7", "") == ["_5f3a", "GUID-7", "requirement-R-3"]


def test_what_is_no_identifier_or_taken_gives_way() -> None:
    assert assign("7", 'a" b', "<x>", "Ö") == [f"requirement-R-{number}" for number in range(1, 5)]
    assert assign("_a", "_a", "requirement-R-1", "type-requirement", "usecase-UC-1") == [
        "_a",
        *(f"requirement-R-{number}" for number in range(2, 6)),
    ]
    assert assign("a" * 501) == ["requirement-R-1"]
