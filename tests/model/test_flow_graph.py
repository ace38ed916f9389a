"""Who feeds whom, between components and between nodes."""

from __future__ import annotations

from collections.abc import Callable

from archgen.model import flow_graph
from archgen.model.architecture import Architecture

Derived = Callable[[str], Architecture]

ROBOT = """
groups:
  g:
    components:
      a: {outputs: {o: T, loop: T}, inputs: {i: a.loop}}
      b: {inputs: {i: a.o}, outputs: {ask: std_srvs/srv/Trigger}}
      c: {inputs: {i: b.ask, j: h}}
  h: {components: {stub: , known: {outputs: {}}}}
"""


def test_components(derived: Derived) -> None:
    found = flow_graph.build_component_graph(derived(ROBOT))
    # A loop on itself feeds nobody else; a service goes both ways; a stub counts, what is known to send nothing does not.
    assert found.successors == {"g.a": ("g.b",), "g.b": ("g.c",), "g.c": ("g.b",), "h.stub": ("g.c",)}
    assert found.predecessors == {"g.b": ("g.a", "g.c"), "g.c": ("g.b", "h.stub")}


def test_nodes_and_topics_that_all_share(derived: Derived) -> None:
    found = flow_graph.build_node_graph(
        derived("""
groups: {g: {components: {a: {outputs: {o: T}}, b: {inputs: {i: a}}, c: {outputs: {o: T}}}}}
nodes:
  x: {implements: a, publishes: {o: /tf}}
  y: {implements: b, internal: {publishes: {t: /tf}}}
  z: {implements: c, internal: {subscribes: {t: /tf}}}
""")
    )
    assert found.successors == {"x": ("y",)}
