"""Read what a project says of its report beside the chapters."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.link import mapping_values
from archgen.model.report_settings import HistoryEntry, ReportSettings
from archgen.syntax.yaml_tree import MappingNode, ScalarNode, SequenceNode

_LEVELS = ("functional", "implementation")


def read_report_settings(root: MappingNode) -> ReportSettings:
    """Read the section `report` of the merged project; what is of the wrong kind reads as not written."""
    report = mapping_values.get_mapping(root, "report")
    level = mapping_values.get_text(report, "level")
    abbreviations = mapping_values.get_mapping(report, "abbreviations")
    return ReportSettings(
        level=level if level in _LEVELS else None,  # type: ignore[arg-type]
        date=mapping_values.get_text(report, "date") or "",
        number=mapping_values.get_text(report, "number") or "",
        authors=mapping_values.get_texts(report, "authors"),
        dissemination=mapping_values.get_text(report, "dissemination") or "",
        history=tuple(_list_versions(report)),
        abbreviations=tuple(
            (entry.key, entry.value.text)
            for entry in abbreviations
            if isinstance(entry.value, ScalarNode) and entry.value.value is not None
        ),
        summary=mapping_values.get_text(report, "summary") or "",
        lists=tuple(
            name  # type: ignore[misc]
            for name in dict.fromkeys(mapping_values.get_texts(report, "lists"))
            if name in {"figures", "tables"}
        ),
        has_large_paper=mapping_values.get_flag(report, "large_paper"),
    )


def _list_versions(report: MappingNode) -> Iterator[HistoryEntry]:
    node = report.get("history")
    for item in node.items if isinstance(node, SequenceNode) else ():
        if isinstance(item, MappingNode):
            values = (mapping_values.get_text(item, key) or "" for key in ("version", "date", "author", "change"))
            yield HistoryEntry(*values)
