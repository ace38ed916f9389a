"""What is wrong in a component type is told once, with its instances."""

from __future__ import annotations

from tests.judged_projects import check_text

TEXT = """
component_types:
  eye: {inputs: {light: T}, outputs: {image: T}}
  head: {components: {left: {is: eye, inputs: {light: {external: E}}}, right: {is: eye, inputs: {light: {external: E}}}}}
groups:
  g:
    components:
      a: {is: head}
      b: {is: head}
      c: {is: eye, inputs: {light: {external: E}}}
types: {T: std_msgs/msg/String}
"""


def test_each_mistake_of_a_type_is_one_finding_that_names_its_instances() -> None:
    unread = [finding for finding in check_text(TEXT) if finding.rule == "unread-output"]
    assert [(finding.span.line, finding.element) for finding in unread] == [(3, "g.a.left")]
    assert [label.text for label in unread[0].labels] == ["in the instance `g.a`, and in `g.b` and `g.c`"]


def test_a_mistake_of_an_instance_stays_its_own() -> None:
    wrong = [
        finding for finding in check_text(f"{TEXT}\nviews: {{v: {{show: xyzzy}}}}") if finding.rule == "wrong-selector"
    ]
    assert [(finding.span.line, finding.labels) for finding in wrong] == [(13, ())]
