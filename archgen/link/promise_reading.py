"""Read what an interface promises and until when it is there. What cannot be is reported, and counts as not written."""

from __future__ import annotations

import re
from datetime import date

from archgen.diagnostics import Diagnostic, Label, Span
from archgen.frozen import dataclass
from archgen.link import mapping_values, sanity_checks
from archgen.model.promise import PROMISE_KEYS, Deprecation, Promise
from archgen.model.quantity import Quantity
from archgen.schema.quantity_wording import clip_text
from archgen.syntax.yaml_tree import MappingNode, ScalarNode

_DIMENSIONS = {"rate": "frequency", "max_gap": "duration", "max_age": "duration"}
_LIMIT = re.compile(
    r"(?P<number>[-+]?(?>[0-9][0-9_]*\.?[0-9]*(?:[eE][-+]?[0-9]+)?|\.[0-9]+(?:[eE][-+]?[0-9]+)?|\.inf)) ?(?P<unit>\S*+)\Z",
    re.IGNORECASE,
)
_MAX_LENGTH = 400


@dataclass(frozen=True, slots=True)
class _WrittenLimit:
    number: float
    unit: str
    at: Span


def read_promise(holder: MappingNode, element_id: str, diagnostics: list[Diagnostic]) -> Promise | None:
    """Return what an output promises, None where it promises nothing."""
    entry = holder.entries.get("promise")
    if entry is None or not isinstance(entry.value, MappingNode):
        return None
    body = entry.value
    figures: dict[str, Quantity | None] = {
        key: sanity_checks.read_positive(body, key, dimension, element_id, diagnostics)
        for key, dimension in _DIMENSIONS.items()
    }
    limits = _read_limits(body, element_id, diagnostics)
    unit = mapping_values.get_text(body, "unit") or next((limit.unit for limit in limits if limit.unit), None)
    promise = Promise(
        **figures,
        unit=unit,
        frame=mapping_values.get_text(body, "frame"),
        range=(limits[0].number, limits[1].number) if limits else None,
        places={key: mapping_values.get_span(body, key) for key in PROMISE_KEYS if body.get(key) is not None},
        at=entry.key_span,
    )
    return promise if any(promise.list_kept()) else None


def _read_limits(body: MappingNode, element_id: str, diagnostics: list[Diagnostic]) -> tuple[_WrittenLimit, ...]:
    """Return the least and the greatest value; nothing, and a diagnostic, where they are not two in one unit."""
    entry = body.entries.get("range")
    if entry is None:
        return ()
    items = mapping_values.get_scalars(body, "range")
    limits: list[_WrittenLimit] = []
    for item in items:
        limit = _read_limit(item)
        if limit is None:
            help_line = "a limit is a number, with or without a unit, such as `0`, `1.5 m` or `.inf`"
            diagnostics.append(
                _diagnose_value(f"`{clip_text(item.text)}` is no limit of a range", item.span, help_line, element_id)
            )
            return ()
        limits.append(limit)
    place = entry.value.span if limits else entry.key_span
    if len(limits) != 2:  # noqa: PLR2004 - least and greatest
        count = {0: "is none", 1: "is one"}.get(len(limits), f"are {len(limits)}")
        message = f"a range has two limits, the least and the greatest value: here {count}"
        diagnostics.append(_diagnose_value(message, place, "write `range: [0, 30]`; `.inf` is no limit", element_id))
        return ()
    least, greatest = limits
    if least.number > greatest.number:
        message = f"the least value ({least.number:g}) is above the greatest ({greatest.number:g})"
        diagnostics.append(_diagnose_value(message, place, "exchange them", element_id))
        return ()
    units = {limit.unit for limit in limits if limit.unit}
    written_unit = mapping_values.get_text(body, "unit")
    if written_unit:
        units.add(written_unit)
    if len(units) > 1:
        message = f"the range is in {' and '.join(f'`{unit}`' for unit in sorted(units))}"
        label = (Label(mapping_values.get_span(body, "unit"), "the unit"),) if written_unit else ()
        diagnostics.append(_diagnose_value(message, place, "write it in one unit", element_id, *label))
        return ()
    return (least, greatest)


def _read_limit(item: ScalarNode) -> _WrittenLimit | None:
    if isinstance(item.value, bool):
        return None
    match = _LIMIT.match(item.text) if len(item.text) < _MAX_LENGTH else None
    if match is None:
        return None
    text = match["number"].replace("_", "").lower()
    number: float = float(text.replace(".inf", "inf"))
    if number.is_integer() and re.fullmatch(r"[-+]?[0-9]{1,18}", text):
        number = int(text)
    return _WrittenLimit(number, match["unit"], item.span)


def read_deprecation(holder: MappingNode, element_id: str, diagnostics: list[Diagnostic]) -> Deprecation | None:
    """Return until when something may be used and what replaces it, None where it is not deprecated."""
    entry = holder.entries.get("deprecated")
    if entry is None or not isinstance(entry.value, MappingNode):
        return None
    body = entry.value
    return Deprecation(
        until=read_day(body, "until", element_id, diagnostics),
        use=mapping_values.get_text(body, "use"),
        at=entry.key_span,
        use_at=mapping_values.get_span(body, "use"),
    )


def read_day(body: MappingNode, key: str, element_id: str, diagnostics: list[Diagnostic]) -> str | None:
    """Return a day as YYYY-MM-DD; one that no calendar has is reported."""
    text = mapping_values.get_text(body, key)
    if text is None or _is_day(text):
        return text
    help_line = "a day is year, month and day, such as `2027-03-01`"
    span = mapping_values.get_span(body, key)
    diagnostics.append(_diagnose_value(f"there is no day `{text}`", span, help_line, element_id))
    return None


def _is_day(text: str) -> bool:
    try:
        return date.fromisoformat(text).isoformat() == text
    except ValueError:
        return False


def _diagnose_value(message: str, span: Span, help_line: str, element_id: str, *labels: Label) -> Diagnostic:
    return Diagnostic("wrong-value", message, span, labels=labels, help=help_line, element=element_id)
