"""What a launch makes of a node's ends is asked of the ends: nobody reads remaps, clocks, overrides or domains a second time."""

from __future__ import annotations

import re

import pytest

from tests.module_graph import list_modules, read_source

_MAY_READ = (
    "archgen.derivation.wire.",
    "archgen.link.",
    "archgen.importers.",
    "archgen.compare.kinds.",
    "archgen.plugins.ros.launch.",
    "archgen.plugins.ros.running_graph.",
    "archgen.plugins.ros.workspace.",
)
_WRITERS = {
    "archgen.bringup.start_commands",
    "archgen.model.parameter_values",
    "archgen.plugins.ros_code.launch_entries",
    "archgen.emit.workspace.own_code",
}
"""What only writes a parameter, or knows that ROS declares it."""


@pytest.mark.parametrize(
    ("words", "sample", "harmless"),
    [
        (r"\b(?!launch\b)\w+\.remaps\b", "node.remaps.items()", "launch.remaps.items()"),
        (r"\"use_sim_time|\"qos_overrides|\"ROS_DOMAIN_ID", 'name == "use_sim_time"', "help=f'write `use_sim_time`'"),
    ],
)
def test_only_the_record_linking_importers_and_comparison_read_it(words: str, sample: str, harmless: str) -> None:
    reads = re.compile(words)
    readers = {
        name
        for name, path in list_modules().items()
        if name.startswith("archgen.") and not name.startswith(_MAY_READ) and reads.search(read_source(path).text)
    }
    assert readers <= _WRITERS
    assert reads.search(sample)
    assert not reads.search(harmless)
