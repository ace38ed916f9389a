"""All passes that ship with archgen, in the order in which they run where one needs the other."""

from __future__ import annotations

from archgen.passes.connection_passes import CONNECT_COMPONENTS, CONNECT_PORTS, CONNECT_TYPES
from archgen.passes.enveloping import ENVELOPE
from archgen.passes.flattening import FLATTEN
from archgen.passes.generic_removal import REMOVE_GENERICS
from archgen.passes.instance_resolution import RESOLVE_INSTANCES
from archgen.passes.monitoring import MONITOR
from archgen.passes.pass_shape import Pass
from archgen.passes.written_out_forms import COMPLETE_NAMES, NORMALISE_CONNECTIONS

_ALL_PASSES = (
    COMPLETE_NAMES,
    NORMALISE_CONNECTIONS,
    CONNECT_COMPONENTS,
    CONNECT_PORTS,
    CONNECT_TYPES,
    RESOLVE_INSTANCES,
    ENVELOPE,
    REMOVE_GENERICS,
    FLATTEN,
    MONITOR,
)
PASSES: dict[str, Pass] = {each.name: each for each in _ALL_PASSES}
"""The passes by name."""
