"""A path of keys leads to what stands there, whatever elements are called."""

from __future__ import annotations

import pytest

from archgen.language.key_paths import find_list_order, find_part


@pytest.mark.parametrize(
    ("path", "part"),
    [
        ("groups", "groups"),
        ("groups g", "group"),
        ("groups g components c inputs i from", "input.from"),
        ("groups g components c inputs tags", "input"),
        ("groups g components c components d timing", "timing"),
        ("component_types t inputs from", "type_input"),
        ("nodes n publishes o topic", "topic_names"),
        ("nodes n parameters tags", ""),
        ("nodes n hints x tags", ""),
        ("use_cases u steps from", "step.from"),
        ("chains from", "chain"),
        ("variants v changes hosts pc cores", "count"),
        ("groups g components c performance accuracy", "performance.accuracy"),
        ("groups g components c performance range", "indicator"),
        ("nothing like this", ""),
    ],
)
def test_a_path_leads_to_its_part(path: str, part: str) -> None:
    assert find_part(path.split()) == part


def test_the_number_of_an_item_may_be_written_or_left_out() -> None:
    assert find_part(("use_cases", "u", "steps", 3, "from")) == find_part(("use_cases", "u", "steps", "from"))
    assert find_part(("groups", "g", "tags", 0)) == "tags[]"


@pytest.mark.parametrize(
    ("path", "order"),
    [
        ("groups g components c tags", "gathered"),
        ("groups g components c inputs tags", "free"),
        ("groups g components c owner", "headed"),
        ("groups g components c parameters mode choices", "free"),
        ("groups g components c parameters laser baud choices", "free"),
        ("groups g components c parameters choices", "counts"),
        ("nodes n parameters from", "counts"),
        ("nodes n arguments", "counts"),
        ("nodes n subscribes tags", "free"),
        ("chains from", "counts"),
        ("chains c through", "counts"),
        ("variants v changes nodes n implements", "free"),
        ("variants v of", "counts"),
        ("review backends", "gathered"),
    ],
)
def test_a_path_says_what_the_order_of_its_list_means(path: str, order: str) -> None:
    assert find_list_order(path.split()) == order
