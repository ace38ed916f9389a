"""Types and composed components that were written to do harm: each ends with a finding, and soon."""

from __future__ import annotations

import pytest

from tests.judged_projects import check_text
from tests.property_sizes import try_some

DEPTH = 3000


def list_errors(text: str) -> set[str]:
    return {finding.rule for finding in check_text(text) if finding.severity == "error"}


def test_types_that_hold_one_another_thousands_deep_are_too_large() -> None:
    types = "\n".join(f"  t{i}: {{components: {{a: {{is: t{i - 1}}}}}}}" for i in range(1, DEPTH))
    text = f"component_types:\n  t0: {{functionality: x}}\n{types}\ngroups: {{g: {{components: {{x: {{is: t{DEPTH - 1}}}}}}}}}"
    assert list_errors(text) == {"too-large"}


def test_types_that_are_made_from_one_another_thousands_of_times_are_too_large() -> None:
    types = "\n".join(f"  t{i}: {{is: t{i - 1}}}" for i in range(1, DEPTH))
    text = f"component_types:\n  t0: {{functionality: x}}\n{types}\ngroups: {{g: {{components: {{x: {{is: t{DEPTH - 1}}}}}}}}}"
    assert list_errors(text) == {"too-large"}


@pytest.mark.slow
@pytest.mark.parametrize(("first_source", "is_fed"), try_some([("source.o", True), (f"c{DEPTH - 1}.o", False)]))
def test_what_only_passes_on_may_stand_in_thousands_behind_one_another(first_source: str, *, is_fed: bool) -> None:
    """A chain of components that hand their input on; and one that ends where it began, so that nothing comes."""
    lines = "".join(
        f"  c{i}: {{is: t, inputs: {{i: {f'c{i - 1}.o' if i else first_source}}}}},\n" for i in range(DEPTH)
    )
    text = (
        "component_types:\n"
        "  t: {inputs: {i: T}, outputs: {o: {from: self.i}}, components: {k: {inputs: {x: self.i}}}}\n"
        f"groups: {{g: {{components: {{\n{lines}  source: {{outputs: {{o: T}}}}}}}}}}"
    )
    findings = {finding.rule for finding in check_text(text)}
    assert list_errors(text) == set()
    assert ("unfed-output" in findings) is not is_fed


def test_hostile_names_of_types_are_refused() -> None:
    text = 'component_types: {t: {generic: [A]}}\ngroups: {g: {components: {x: {is: "t<' + "<" * 200 + '"}}}}'
    assert list_errors(text) == {"wrong-value"}
