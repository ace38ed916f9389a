"""Find groups whose components are lines of their description: indented a little too far, they belong to that text."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.syntax.yaml_tree import MappingNode, ScalarNode

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.syntax.yaml_tree import MappingEntry, YamlDocument

_COMPONENTS_IN_TEXT = re.compile(
    r"(?:^|(?<= ))components:[ ]*\n(?:[ ]*\n)*[ ]+[a-z][a-z0-9_]*:(?:[ ]*\n| \{)", re.MULTILINE
)
"""The key, and below it, further in, the line of a component in its long form or in braces: `lidar: sees the room` may be
prose. Where the text is folded, the key may stand behind the text's last words.
"""


def find_swallowed_components(document: YamlDocument) -> Iterator[Diagnostic]:
    """Report the descriptions of groups that hold the group's components.

    A group that has components besides is left alone: its description may well show how a project is written.
    """
    groups = document.root.get("groups")
    for group in groups if isinstance(groups, MappingNode) else ():
        body = group.value
        if isinstance(body, MappingNode) and "components" not in body.entries and "description" in body.entries:
            yield from _check_description(body.entries["description"], group.key)


def _check_description(entry: MappingEntry, group: str) -> Iterator[Diagnostic]:
    if isinstance(entry.value, ScalarNode) and _COMPONENTS_IN_TEXT.search(entry.value.text):
        yield Diagnostic(
            "wrong-value",
            "`components:` and what stands below it are lines of the text `description`",
            entry.key_span,
            help="begin `components:` in the column of `description:`",
            element=group,
        )
