"""Pictures as Mermaid flowcharts: the forms of what is composed."""

from __future__ import annotations

from archgen.emit.markdown.mermaid_chart import write_flowchart
from archgen.views.picture_shapes import Arrow, Box, Cluster, Graph


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


def test_frames_stand_in_frames() -> None:
    graph = Graph(
        "g",
        "G",
        "framed",
        (Box("a", "A", cluster="inner"), Box("b", "B", cluster="outer"), Box("c", "C")),
        (),
        clusters=(Cluster("outer", "Outer"), Cluster("inner", "Inner", parent="outer")),
        kind="view",
    )
    assert list(write_flowchart(graph))[:8] == [
        "flowchart LR",
        '  n2("C")',
        '  subgraph g0["Outer"]',
        '    n1("B")',
        '    subgraph g1["Inner"]',
        '      n0("A")',
        "    end",
        "  end",
    ]


def test_what_is_no_ros_has_a_round_end_and_its_medium_in_brackets() -> None:
    boxes = (Box("a", "A"), Box("b", "B"))
    arrows = (
        Arrow("1", "a", "b", label="Pose\n(MQTT)", medium="MQTT"),
        Arrow("2", "a", "b", medium="CAN", count=2),
        Arrow("3", "a", "b", style="service", medium="REST"),
        Arrow("4", "a", "b", style="action", medium="gRPC"),
        Arrow("5", "a", "b", is_made=True, medium="x"),
    )
    assert list(write_flowchart(Graph("g", "G", "flow", boxes, arrows, kind="ros")))[3:] == [
        '  n0 --o|"Pose<br>(MQTT)"| n1',
        '  n0 --o|"2<br>(CAN)"| n1',
        '  n0 -.-o|"(REST)"| n1',
        '  n0 ==o|"(gRPC)"| n1',
        '  n0 -.-o|"(x)"| n1',
    ]
