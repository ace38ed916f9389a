"""What reads the keys for which the normal form of their type does not do.

A key with keys below it is read off what its function returns, key by key.
"""

from __future__ import annotations

from collections.abc import Mapping

from archgen.compare.kinds import (
    component_keys,
    node_readers,
    project_readers,
    promise_keys,
    system_readers,
    timing_readers,
    type_readers,
)
from archgen.compare.kinds.key_spec import Reader

READERS: Mapping[tuple[str, str], Reader] = {
    ("project", "id"): project_readers.read_project_id,
    ("project", "title"): project_readers.read_project_title,
    ("use_case", "actors."): project_readers.read_actors,
    ("use_case", "steps"): project_readers.read_steps,
    ("requirement", "verified_by"): project_readers.read_verifications,
    ("component", "title"): component_keys.read_name_as_title,
    ("component", "is"): component_keys.read_component_type,
    ("component", "requirements"): component_keys.read_requirements,
    ("component", "performance."): component_keys.find_indicators,
    ("component", "inputs"): component_keys.read_inputs,
    ("component", "outputs"): component_keys.read_outputs,
    ("component", "parameters."): component_keys.read_parameters,
    ("component", "operations."): component_keys.read_operations,
    ("component", "timing."): component_keys.find_node_timing,
    ("component_type", "is"): component_keys.read_base,
    ("component_type", "deprecated."): promise_keys.find_component_type_deprecation,
    ("input", "medium"): component_keys.read_medium,
    ("output", "medium"): component_keys.read_medium,
    ("output", "deprecated."): promise_keys.find_output_deprecation,
    ("type", "fields."): type_readers.read_fields,
    ("type", "deprecated."): promise_keys.find_type_deprecation,
    ("frame", "by"): system_readers.read_writer,
    ("promise", "range"): promise_keys.read_range,
    ("node", "name"): node_readers.read_ros_name,
    ("node", "command"): node_readers.read_command,
    ("node", "arguments"): node_readers.read_arguments,
    ("node", "host"): node_readers.read_host,
    ("node", "callback_groups."): node_readers.read_callback_groups,
    ("node", "parameters."): node_readers.read_parameters,
    ("node", "parameter_commands."): node_readers.read_commands,
    ("node", "start."): node_readers.find_start,
    ("node", "timing."): node_readers.find_untold_timing,
    ("host", "scheduling."): system_readers.read_core_orders,
    ("link", "latency."): system_readers.find_latency,
    ("start", "after"): node_readers.read_start_targets,
    ("start", "by"): node_readers.read_start_manager,
    ("policy", "forbid."): system_readers.find_forbidden_flow,
    ("policy", "accepted."): system_readers.read_accepted,
    ("forbid", "from"): system_readers.make_selector_reader("forbid_from"),
    ("forbid", "to"): system_readers.make_selector_reader("forbid_to"),
    ("require", "of"): system_readers.make_selector_reader("of"),
    ("require", "inputs_from"): system_readers.make_selector_reader("inputs_from"),
    ("timing", "rate"): timing_readers.read_rate,
    ("timing", "wcet."): timing_readers.read_measured_times,
    ("timing", "trigger"): timing_readers.read_trigger,
    ("timing", "trigger."): timing_readers.read_trigger_facets,
    ("timing", "inputs."): timing_readers.find_input_timing,
    ("timing", "outputs."): timing_readers.find_output_timing,
    ("timing", "calls."): timing_readers.read_calls,
    ("timing", "uses."): timing_readers.read_uses,
    ("timing", "core"): timing_readers.read_core,
    ("timing", "cores"): timing_readers.read_cores,
    ("timing_input", "stored"): timing_readers.read_stored,
    ("chain", "through"): system_readers.read_way,
    ("chain", "deadline."): system_readers.read_deadline_shares,
    ("view", "show"): system_readers.make_selector_reader("show"),
    ("variant", "without"): system_readers.make_selector_reader("without"),
    ("variant", "changes"): system_readers.read_variant_changes,
}
"""By kind and key."""
