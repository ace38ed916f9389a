"""Names are ordered as people count."""

from __future__ import annotations

from archgen.diagnostics.natural_order import order_naturally


def test_numbers_count_by_their_value_and_any_two_names_differ() -> None:
    names = ["g10", "G2", "g2", "", "9" * 4000, "a", "10", "9", "g2b", "g02", "é1", "g2.c10", "g2.c9"]
    ordered = sorted(names, key=order_naturally)
    assert ordered.index("g2") < ordered.index("g10")
    assert ordered.index("9") < ordered.index("10")
    assert ordered.index("g2.c9") < ordered.index("g2.c10")
    assert len(set(map(order_naturally, names))) == len(names)
    assert ordered == sorted(set(names), key=order_naturally)
