"""What a node's `remaps` make of its names is asked of its endpoints: nobody applies the rules a second time."""

from __future__ import annotations

import re

from tests.module_graph import list_modules, read_source

_READS = re.compile(r"\b(?!launch\b)\w+\.remaps\b")
_MAY_READ = (
    "archgen.derivation.wire.",
    "archgen.link.",
    "archgen.importers.",
    "archgen.compare.kinds.",
    "archgen.plugins.ros.launch.",
)


def test_only_the_record_linking_importers_and_comparison_read_remaps() -> None:
    readers = {
        name
        for name, path in list_modules().items()
        if name.startswith("archgen.") and not name.startswith(_MAY_READ) and _READS.search(read_source(path).text)
    }
    assert readers == set()
    assert _READS.search("node.remaps.items()")
    assert not _READS.search("launch.remaps.items()")
