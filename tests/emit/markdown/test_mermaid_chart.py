"""Pictures as Mermaid flowcharts: the forms of what is composed."""

from __future__ import annotations

from archgen.emit.markdown.mermaid_chart import write_flowchart
from archgen.views.graph_shapes import Arrow, Box, Graph


def test_composed_components_ports_and_made_connections_have_forms_of_their_own() -> None:
    boxes = (Box("a", "Arm", style="composed"), Box("p", "goal", style="port"), Box("b", "Leaf"))
    arrows = (Arrow("1", "p", "a"), Arrow("2", "a", "b", is_made=True))
    assert list(write_flowchart(Graph("g", "G", "flow", boxes, arrows, kind="composed"))) == [
        "flowchart LR",
        '  n0[["Arm"]]',
        '  n1["goal"]',
        '  n2("Leaf")',
        "  n1 --> n0",
        "  n0 -.-> n2",
    ]
