"""Read what a project says of its report beside the chapters."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.link import mapping_values
from archgen.link.value_readers import read_values
from archgen.model.report_settings import HistoryEntry, ReportSettings
from archgen.syntax.yaml_tree import MappingNode, ScalarNode, SequenceNode


def read_report_settings(root: MappingNode) -> ReportSettings:
    """Read the section `report` of the merged project; what is of the wrong kind reads as not written."""
    report = mapping_values.get_mapping(root, "report")
    abbreviations = mapping_values.get_mapping(report, "abbreviations")
    return ReportSettings(
        **read_values("report", ReportSettings, report),
        history=tuple(_list_versions(report)),
        abbreviations=tuple(
            (entry.key, entry.value.text)
            for entry in abbreviations
            if isinstance(entry.value, ScalarNode) and entry.value.value is not None
        ),
        lists=tuple(
            name  # type: ignore[misc]
            for name in dict.fromkeys(mapping_values.get_texts(report, "lists"))
            if name in {"figures", "tables"}
        ),
    )


def _list_versions(report: MappingNode) -> Iterator[HistoryEntry]:
    node = report.get("history")
    for item in node.items if isinstance(node, SequenceNode) else ():
        if isinstance(item, MappingNode):
            values = (mapping_values.get_text(item, key) or "" for key in ("version", "date", "author", "change"))
            yield HistoryEntry(*values)
