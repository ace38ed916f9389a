"""The words of scheduling are the same in the schema, where editors offer them, and in the model."""

from __future__ import annotations

import pytest

from archgen.model.declared_timing import EXECUTOR_ORDERS, HOST_ORDERS, PERCENTILES, RESOURCE_ORDERS
from archgen.schema.language_schema import load_schema


@pytest.mark.parametrize(
    ("definition", "orders"),
    [
        ("host_order", HOST_ORDERS),
        ("host_scheduling", HOST_ORDERS),
        ("executor_order", EXECUTOR_ORDERS),
        ("resource_order", RESOURCE_ORDERS),
    ],
)
def test_the_schema_allows_the_orders_of_the_model(definition: str, orders: tuple[str, ...]) -> None:
    assert load_schema()["$defs"][definition]["pattern"] == f"^(?:{'|'.join(orders)})$"


def test_the_schema_allows_the_percentiles_of_the_model() -> None:
    keys = load_schema()["$defs"]["execution_time"]["properties"]
    assert tuple(key for key in keys if key not in {"max", "measured"}) == PERCENTILES
