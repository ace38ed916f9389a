"""What a bus is called as a medium, and which bus something is bound to."""

from __future__ import annotations

import re

from archgen.plugin.importing import make_id
from archgen.plugin.model import MEDIUM_NAMES
from archgen.plugins.aadl.aadl_tree import Path
from archgen.plugins.aadl.property_values import PropertyScope, read_references
from archgen.plugins.aadl.resolved_classifiers import ResolvedPart


def name_bus_medium(part: ResolvedPart) -> str:
    """Return a medium that the name of a bus or of its classifier holds, else the classifier's own name as a word."""
    classifier = part.use.full_name.rpartition("::")[2].partition(".")[0]
    names: tuple[str, str] = (classifier, part.written.name)
    for name in names:
        words: list[str] = re.findall(r"[a-z0-9]+", re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name).lower())
        for word in words:
            if word in MEDIUM_NAMES and word not in {"ros", "memory", "file"}:
                return word
    return make_id(classifier or part.written.name, "bus")[:40].strip("_")


def read_bound_path(scope: PropertyScope, connection_name: str) -> Path:
    """Return the path of the bus that a connection is bound to, the first of several; empty where it is bound to none."""
    if not connection_name:
        return ()
    paths = read_references(scope.value((connection_name.lower(),), "actual_connection_binding"))
    return paths[0] if paths else ()
