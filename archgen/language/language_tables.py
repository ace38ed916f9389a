"""The language as tables. Written by `make language` from the description in `language/`: edit that, never this.

A part is a kind (it has keys), a type, or what stands at one key alone: `KIND.KEY`; `PART.*` are the values of a mapping
by id that have no name of their own, `PART[]` the items of such a list.
"""

# fmt: off
from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

KindName = Literal[
    "slice", "project", "partner", "milestone", "agreement", "interface_terms", "agreed_terms", "signature", "ros",
    "rules", "layout", "report", "review", "accepted", "accepted_key", "conform", "generate", "accepted_difference",
    "site", "variant", "variant_changes", "library", "use_case", "actor", "step", "requirement", "property_declaration",
    "view", "group", "component", "component_type", "component_node", "input", "output", "type_input", "performance",
    "indicator", "operation", "parameter", "parameter_declaration", "type", "field", "constant", "frame", "promise",
    "deprecation", "node", "internal", "topic_use", "call_use", "qos", "host", "host_scheduling", "fair_scheduling",
    "container", "resource", "link", "start", "start_ready", "policy", "require", "forbid", "timing", "timing_input",
    "timing_output", "timing_use", "trigger", "execution_time", "latency", "chain",
]
SectionName = Literal[
    "archgen", "project", "sources", "partners", "agreements", "ros", "rules", "layout", "report", "use_cases",
    "requirements", "properties", "glossary", "component_types", "libraries", "groups", "nodes", "types", "hosts",
    "containers", "resources", "links", "frames", "chains", "views", "policies", "review", "conform", "generate",
    "site", "variants", "milestones",
]

KEYS: Mapping[str, Mapping[str, str]] = {
    "slice": {
        "archgen": "slice.archgen", "project": "project", "sources": "files", "partners": "partners",
        "agreements": "agreements", "ros": "ros", "rules": "rules", "layout": "layout", "report": "report",
        "use_cases": "use_cases", "requirements": "requirements", "properties": "property_declarations",
        "glossary": "glossary", "component_types": "component_types", "libraries": "libraries", "groups": "groups",
        "nodes": "nodes", "types": "types", "hosts": "hosts", "containers": "containers", "resources": "resources",
        "links": "links", "frames": "frames", "chains": "chains", "views": "views", "policies": "policies",
        "review": "review", "conform": "conform", "generate": "generate", "site": "site", "variants": "variants",
        "milestones": "milestones",
    },
    "project": {
        "id": "id", "title": "text", "version": "text", "description": "prose", "license": "text",
        "middleware": "project.middleware",
    },
    "partner": {
        "title": "text", "description": "prose", "contact": "text", "reviewers": "reviewers",
        "properties": "properties", "hints": "hints",
    },
    "milestone": {
        "title": "text", "description": "prose", "date": "day", "needs": "milestone.needs", "properties": "properties",
        "hints": "hints",
    },
    "agreement": {
        "terms": "agreed_terms", "interfaces": "agreement.interfaces", "signed": "signature",
    },
    "interface_terms": {
        "late": "text", "stamps": "text", "clock": "text", "start": "text", "duties": "text",
    },
    "agreed_terms": {
        "late": "text", "stamps": "text", "clock": "text", "start": "text", "duties": "text", "notice": "text",
        "validity": "text", "other": "text",
    },
    "signature": {
        "rules": "count", "tag": "text", "revision": "signature.revision", "terms": "version_digits",
        "by": "signature.by", "versions": "signature.versions",
    },
    "ros": {
        "distro": "ros.distro", "interfaces": "files", "shared_topics": "shared_topics", "parameters": "ros_parameters",
        "environment": "start_environment", "discovery": "ros.discovery", "definitions": "definitions",
        "parameter_texts": "parameter_texts",
    },
    "rules.gap-above-promise": {
        "severity": "severity", "margin": "percentage",
    },
    "rules.large-jitter": {
        "severity": "severity", "limit": "percentage",
    },
    "rules.larger-than-modelled": {
        "severity": "severity", "margin": "percentage",
    },
    "rules.late-chain": {
        "severity": "severity", "margin": "percentage",
    },
    "rules.late-first-message": {
        "severity": "severity", "margin": "percentage",
    },
    "rules.long-execution": {
        "severity": "severity", "limit": "percentage",
    },
    "rules.lost-samples": {
        "severity": "severity", "tolerance": "percentage",
    },
    "rules.overloaded-host": {
        "severity": "severity", "limit": "percentage",
    },
    "rules.period-conflict": {
        "severity": "severity", "tolerance": "percentage",
    },
    "rules.rate-below-promise": {
        "severity": "severity", "margin": "percentage",
    },
    "rules.saturated-link": {
        "severity": "severity", "limit": "percentage",
    },
    "rules.short-queue": {
        "severity": "severity", "margin": "percentage",
    },
    "rules.slow-component": {
        "severity": "severity", "margin": "percentage",
    },
    "rules.slow-service": {
        "severity": "severity", "margin": "percentage",
    },
    "rules.*": {
        "severity": "severity",
    },
    "rules": {
        "gap-above-promise": "rules.gap-above-promise", "large-jitter": "rules.large-jitter",
        "larger-than-modelled": "rules.larger-than-modelled", "late-chain": "rules.late-chain",
        "late-first-message": "rules.late-first-message", "long-execution": "rules.long-execution",
        "lost-samples": "rules.lost-samples", "overloaded-host": "rules.overloaded-host",
        "period-conflict": "rules.period-conflict", "rate-below-promise": "rules.rate-below-promise",
        "saturated-link": "rules.saturated-link", "short-queue": "rules.short-queue",
        "slow-component": "rules.slow-component", "slow-service": "rules.slow-service",
    },
    "layout": {
        "direction": "direction",
    },
    "report.history[]": {
        "version": "text", "date": "report.history[].date", "author": "text", "change": "text",
    },
    "report": {
        "chapters": "chapters", "level": "level", "date": "report.date", "number": "text", "authors": "report.authors",
        "dissemination": "text", "history": "report.history", "abbreviations": "report.abbreviations",
        "summary": "text", "lists": "report.lists", "large_paper": "report.large_paper", "texts": "report.texts",
        "pictures": "report.pictures",
    },
    "review.breaking": {
        "wire": "severity", "promise": "severity", "meaning": "severity", "source": "severity", "foreign": "severity",
        "agreement": "severity",
    },
    "review": {
        "main": "text", "breaking": "review.breaking", "accepted": "review.accepted", "backends": "review.backends",
        "noise": "percentage", "passes": "review.passes",
    },
    "accepted": {
        "reason": "text", "key": "text", "was": "text",
    },
    "accepted_key": {
        "reason": "text", "key": "text", "was": "text",
    },
    "conform": {
        "against": "listed_texts", "launch": "listed_texts", "ignore": "listed_texts", "accepted": "conform.accepted",
    },
    "generate": {
        "into": "text", "backends": "generate.backends",
    },
    "accepted_difference": {
        "rule": "listed_texts", "reason": "text", "until": "text",
    },
    "site": {
        "repository": "repository_address", "branch": "text", "folder": "text", "forge": "forge",
    },
    "variant": {
        "title": "text", "description": "prose", "of": "variant.of", "without": "variant.without", "drop": "key_paths",
        "changes": "variant_changes",
    },
    "variant_changes": {
        "partners": "partners", "ros": "ros", "rules": "rules", "layout": "layout", "report": "report",
        "use_cases": "use_cases", "requirements": "requirements", "properties": "property_declarations",
        "glossary": "glossary", "component_types": "changed_component_types", "groups": "groups", "nodes": "nodes",
        "types": "types", "hosts": "hosts", "containers": "containers", "resources": "resources", "links": "links",
        "frames": "frames", "chains": "chains", "views": "views", "policies": "policies", "generate": "generate",
        "site": "site", "milestones": "milestones",
    },
    "library": {
        "path": "library_path", "package": "package_name", "component_types": "component_types", "types": "types",
    },
    "use_case": {
        "title": "text", "description": "prose", "actors": "actors", "steps": "steps", "properties": "properties",
        "hints": "hints",
    },
    "actor": {
        "title": "text",
    },
    "step": {
        "from": "step.from", "to": "step.to", "say": "text",
    },
    "requirement": {
        "title": "text", "description": "prose", "parent": "requirement.parent", "kind": "requirement_word",
        "priority": "requirement_word", "rationale": "prose", "source": "text",
        "verified_by": "requirement.verified_by", "use_cases": "requirement.use_cases", "tags": "tags", "urls": "urls",
        "properties": "properties", "hints": "hints",
    },
    "property_declaration": {
        "title": "text", "description": "prose", "of": "declared_of", "type": "property_declaration.type",
        "unit": "text", "range": "property_declaration.range", "choices": "property_declaration.choices",
        "required": "flag",
    },
    "view": {
        "title": "text", "show": "view.show", "colour": "view.colour", "level": "level", "depth": "view.depth",
        "layout": "layout", "properties": "properties", "hints": "hints",
    },
    "group": {
        "title": "text", "description": "prose", "owner": "owners", "tags": "tags", "urls": "urls", "layout": "layout",
        "components": "components", "autoconnect": "autoconnect", "properties": "properties", "hints": "hints",
    },
    "component": {
        "title": "text", "functionality": "prose", "description": "prose", "is": "component_type_name",
        "same_as": "component_type_name", "owner": "owners", "role": "role", "requirements": "component_requirements",
        "performance": "performance", "inputs": "inputs", "outputs": "outputs", "parameters": "component_parameters",
        "open": "open_sets", "operations": "operations", "from": "references", "components": "components",
        "autoconnect": "autoconnect", "node": "component_node", "containers": "containers", "timing": "timing",
        "frames": "frames", "tags": "tags", "urls": "urls", "layout": "layout", "properties": "properties",
        "hints": "hints", "status": "node_status", "contact": "text", "image": "text",
    },
    "component_type": {
        "title": "text", "functionality": "prose", "description": "prose", "is": "component_type_name",
        "owner": "owners", "role": "role", "requirements": "component_requirements", "performance": "performance",
        "inputs": "type_inputs", "outputs": "outputs", "parameters": "component_parameters", "open": "open_sets",
        "operations": "operations", "components": "components", "autoconnect": "autoconnect", "node": "component_node",
        "containers": "containers", "timing": "timing", "frames": "frames", "tags": "tags", "urls": "urls",
        "layout": "layout", "properties": "properties", "hints": "hints", "status": "node_status", "contact": "text",
        "image": "text", "generic": "generic_names", "abstract": "flag", "version": "text", "deprecated": "deprecation",
    },
    "component_node": {
        "name": "text", "own_name": "text", "inner_nodes": "inner_nodes", "namespace": "text", "kind": "node_kinds",
        "package": "text", "executable": "text", "plugin": "text", "language": "code_language", "command": "command",
        "arguments": "texts", "remaps": "remaps", "container": "component_node.container",
        "host": "component_node.host", "threads": "count", "scheduling": "executor_order", "reentrant": "flag",
        "status": "node_status", "observed": "flag", "publishes": "topics", "subscribes": "topics", "serves": "calls",
        "calls": "calls", "parameters": "component_node.parameters", "parameter_files": "texts",
        "parameter_commands": "parameter_commands", "start": "start", "tags": "tags", "urls": "urls",
        "properties": "properties", "hints": "hints", "whole": "flag",
    },
    "input": {
        "from": "input.from", "external": "text", "medium": "input.medium", "type": "type_name", "optional": "flag",
        "freshness": "duration", "frame": "input.frame", "description": "prose", "properties": "properties",
        "hints": "hints", "urls": "urls",
    },
    "output": {
        "type": "type_name", "from": "references", "to": "references", "external": "text", "medium": "output.medium",
        "frame": "output.frame", "description": "prose", "promise": "promise", "version": "text",
        "deprecated": "deprecation", "properties": "properties", "hints": "hints", "urls": "urls",
    },
    "type_input": {
        "external": "text", "medium": "type_input.medium", "type": "type_name", "optional": "flag",
        "freshness": "duration", "frame": "type_input.frame", "description": "prose", "properties": "properties",
        "hints": "hints", "urls": "urls",
    },
    "performance.accuracy": {
        "title": "text", "accuracy": "text", "execution_time": "duration",
    },
    "performance.execution_time": {
        "title": "text", "accuracy": "text", "execution_time": "duration",
    },
    "performance": {
        "accuracy": "performance.accuracy", "execution_time": "performance.execution_time",
    },
    "indicator": {
        "title": "text", "accuracy": "text", "execution_time": "duration",
    },
    "operation": {
        "title": "text", "request": "operation.request", "response": "operation.response", "call": "operation.call",
        "visibility": "visibility", "description": "prose",
    },
    "parameter": {
        "type": "parameter.type", "value": "parameter.value", "unit": "parameter.unit", "range": "parameter.range",
        "choices": "parameter.choices", "description": "parameter.description", "read_only": "parameter.read_only",
        "visibility": "parameter.visibility", "from": "parameter.from", "hints": "parameter.hints",
    },
    "parameter_declaration": {
        "type": "parameter_declaration.type", "value": "parameter_declaration.value", "unit": "text",
        "range": "parameter_declaration.range", "choices": "parameter_declaration.choices", "description": "prose",
        "read_only": "flag", "visibility": "visibility", "from": "parameter_declaration.from",
        "hints": "parameter_declaration.hints",
    },
    "type": {
        "message": "type.message", "fields": "fields", "constants": "constants", "values": "enumeration",
        "generic": "type_parameters", "comment": "prose", "size": "size", "status": "status", "frame": "type.frame",
        "request": "message_part", "response": "message_part", "feedback": "message_part", "version": "text",
        "deprecated": "deprecation", "properties": "properties", "hints": "hints",
    },
    "field": {
        "type": "field_type", "default": "field_value", "unit": "text", "comment": "text",
    },
    "constant": {
        "type": "constant_type", "value": "text", "comment": "text",
    },
    "frame": {
        "parent": "frame.parent", "by": "frame.by", "rate": "frequency", "static": "flag", "title": "text",
        "properties": "properties", "hints": "hints",
    },
    "promise": {
        "rate": "frequency", "max_gap": "duration", "max_age": "duration", "unit": "text", "frame": "promise.frame",
        "range": "promised_range",
    },
    "deprecation": {
        "until": "day", "use": "text",
    },
    "node": {
        "implements": "node.implements", "title": "text", "description": "prose", "owner": "owners", "name": "text",
        "own_name": "text", "inner_nodes": "inner_nodes", "namespace": "text", "kind": "node_kinds", "package": "text",
        "executable": "text", "plugin": "text", "language": "code_language", "command": "command", "arguments": "texts",
        "remaps": "remaps", "container": "node.container", "host": "node.host", "threads": "count",
        "scheduling": "executor_order", "callback_groups": "callback_groups", "reentrant": "flag",
        "status": "node_status", "observed": "flag", "publishes": "topics", "subscribes": "topics", "serves": "calls",
        "calls": "calls", "internal": "internal", "timing": "timing", "parameters": "node.parameters",
        "parameter_files": "texts", "parameter_commands": "parameter_commands", "start": "start", "tags": "tags",
        "urls": "urls", "properties": "properties", "hints": "hints",
    },
    "internal": {
        "publishes": "internal_topics", "subscribes": "internal_topics", "serves": "internal_calls",
        "calls": "internal_calls",
    },
    "topic_use": {
        "topic": "topic_names", "own_name": "topic_name_or_nothing", "named_by": "parameter_template",
        "when": "port_conditions", "message": "topic_use.message", "qos": "qos",
    },
    "call_use": {
        "name": "topic_name_or_nothing", "own_name": "topic_name_or_nothing", "named_by": "parameter_template",
        "when": "port_conditions", "message": "call_use.message",
    },
    "qos": {
        "profile": "qos_profile", "reliability": "qos_reliability", "durability": "qos_durability",
        "history": "qos_history", "depth": "count", "deadline": "duration", "lifespan": "duration",
        "liveliness": "qos_liveliness", "lease_duration": "duration",
    },
    "host": {
        "title": "text", "cores": "count", "scheduling": "host_scheduling", "description": "prose",
        "address": "host_address", "discovery_server": "port_number", "environment": "start_environment",
        "tags": "tags", "properties": "properties", "hints": "hints",
    },
    "host_scheduling": {
        "fair": "fair_scheduling",
    },
    "fair_scheduling": {
        "slice": "duration", "tick": "duration", "lead": "count", "other_load": "fair_scheduling.other_load",
    },
    "container": {
        "title": "text", "namespace": "text", "name": "text", "package": "text", "executable": "text",
        "parameters": "container.parameters", "host": "container.host", "threads": "count",
        "scheduling": "executor_order", "properties": "properties", "hints": "hints",
    },
    "resource": {
        "title": "text", "host": "resource.host", "scheduling": "resource_order", "properties": "properties",
        "hints": "hints",
    },
    "link": {
        "connects": "link.connects", "bandwidth": "bandwidth", "latency": "latency", "protocol": "link.protocol",
        "title": "text", "owner": "link.owner", "properties": "properties", "hints": "hints",
    },
    "start": {
        "phase": "start_phase", "after": "start.after", "ready": "start_ready", "respawn": "flag",
        "respawn_delay": "duration", "environment": "start_environment", "directory": "text", "user": "system_user",
        "once": "flag", "state": "start_state", "by": "start.by",
    },
    "start_ready": {
        "port": "port_number", "file": "text", "topic": "topic_name_or_nothing", "service": "topic_name_or_nothing",
        "log": "text", "wait": "duration", "within": "duration",
    },
    "policy": {
        "title": "text", "forbid": "forbid", "require": "require", "accepted": "policy_exceptions",
        "properties": "properties", "hints": "hints",
    },
    "require": {
        "of": "require.of", "inputs_from": "require.inputs_from", "guarded_by": "id",
    },
    "forbid": {
        "from": "forbid.from", "to": "forbid.to",
    },
    "timing": {
        "behaviour": "behaviour", "period": "duration", "rate": "frequency", "jitter": "duration",
        "wcet": "execution_time", "bcet": "duration", "trigger": "trigger", "every": "count", "throttle": "duration",
        "dropped": "dropped", "inputs": "timing_inputs", "outputs": "timing_outputs", "calls": "timing_calls",
        "uses": "timing_uses", "priority": "index", "deadline": "duration", "core": "index", "cores": "core_list",
        "response": "duration",
    },
    "timing_input": {
        "wcet": "duration", "bcet": "duration", "stored": "timing_input.stored", "memory": "timing_input.memory",
    },
    "timing_output": {
        "conditional": "flag", "max_gap": "duration",
    },
    "timing_use": {
        "max": "duration", "min": "duration",
    },
    "trigger": {
        "all": "port_list", "match": "port_list", "within": "duration",
    },
    "execution_time": {
        "max": "duration", "p50": "duration", "p90": "duration", "p95": "duration", "p99": "duration",
        "measured": "flag",
    },
    "latency": {
        "best": "duration", "worst": "duration",
    },
    "chain": {
        "through": "chain.through", "deadline": "chain_deadline", "title": "text", "requirements": "chain.requirements",
        "properties": "properties", "hints": "hints",
    },
}
"""The part that stands at each key of each kind."""
ENTRIES: Mapping[str, str] = {
    "actors": "actor", "agreements": "agreement", "callback_groups": "group_components", "calls": "call_use",
    "chain_deadline": "duration", "chains": "chain", "changed_component_types": "component_type",
    "component_parameters": "parameter", "component_types": "component_type", "components": "component",
    "constants": "constant", "containers": "container", "definitions": "definitions.*", "fields": "field",
    "frames": "frame", "glossary": "text", "groups": "group", "hosts": "host", "inputs": "input",
    "inner_nodes": "inner_nodes.*", "internal_calls": "call_use", "internal_topics": "topic_use",
    "libraries": "library", "links": "link", "message_part": "field", "nodes": "node",
    "operation_fields": "operation_fields.*", "operations": "operation", "outputs": "output",
    "parameter_commands": "parameter_commands.*", "parameter_set": "parameter", "parameter_texts": "parameter_texts.*",
    "partners": "partner", "policies": "policy", "policy_exceptions": "text", "port_conditions": "port_conditions.*",
    "properties": "text", "property_declarations": "property_declaration", "remaps": "remaps.*",
    "requirements": "requirement", "resources": "resource", "start_environment": "start_environment.*",
    "timing_calls": "timing_calls.*", "timing_inputs": "timing_input", "timing_outputs": "timing_output",
    "timing_uses": "timing_use", "topics": "topic_use", "type_inputs": "type_input", "types": "type", "urls": "urls.*",
    "use_cases": "use_case", "variants": "variant", "views": "view", "milestones": "milestone",
    "agreement.interfaces": "interface_terms", "signature.by": "text", "signature.versions.*": "version_digits",
    "signature.versions": "signature.versions.*", "rules": "rules.*", "report.abbreviations": "text",
    "report.texts": "report.texts.*", "report.pictures": "report.pictures.*", "review.accepted": "accepted",
    "conform.accepted": "accepted_difference", "generate.backends.*": "generate.backends.*.*",
    "generate.backends": "generate.backends.*", "performance": "indicator", "operation.request": "operation.request.*",
    "operation.response": "operation.response.*", "parameter": "parameter", "host_scheduling": "host_order",
}
"""Mappings by id: the part of their values."""
ITEMS: Mapping[str, str] = {
    "chapters": "chapters[]", "command": "command[]", "component_requirements": "component_requirements[]",
    "components": "component_type_item", "core_list": "core_list[]", "declared_of": "declared_of[]",
    "enumeration": "enumeration[]", "field_value": "field_value[]", "files": "files[]", "generic_names": "generic_name",
    "group_components": "reference_item", "inputs": "port_type_item", "key_paths": "key_path",
    "link_ends": "reference_item", "node_kinds": "node_kind_item", "open_sets": "open_sets[]",
    "outputs": "port_type_item", "owners": "owners[]", "parameter_commands.*": "parameter_commands.*[]",
    "parameter_set": "parameter_value", "port_conditions.*": "port_conditions.*[]", "port_list": "port_path",
    "promised_range": "promised_limit", "references": "reference_item", "requirement_ids": "requirement_ids[]",
    "requirement_parents": "requirement_parents[]", "reviewers": "reviewers[]", "shared_topics": "topic_name",
    "steps": "step", "tags": "tags[]", "listed_texts": "listed_texts[]", "texts": "texts[]",
    "topic_names": "topic_name", "type_inputs": "port_type_item", "type_parameters": "type_parameters[]",
    "variant_ids": "variant_id", "verifications": "verifications[]", "way": "reference_item",
    "report.authors": "report.authors[]", "report.history": "report.history[]", "report.lists": "report.lists[]",
    "review.backends": "review.backends[]", "review.passes": "review.passes[]", "accepted": "accepted_key",
    "variant.of": "variant_id", "requirement.parent": "requirement.parent[]",
    "requirement.verified_by": "requirement.verified_by[]", "requirement.use_cases": "requirement.use_cases[]",
    "property_declaration.range": "range_limit", "property_declaration.choices": "parameter_value",
    "input.from": "reference_item", "input": "reference_item", "parameter_declaration.value": "parameter_value",
    "parameter_declaration.range": "range_limit", "parameter_declaration.choices": "parameter_value",
    "node.implements": "reference_item", "node": "reference_item", "topic_use": "topic_name",
    "link.connects": "reference_item", "link": "reference_item", "start.after": "reference_item",
    "start": "reference_item", "trigger": "port_path", "chain.through": "reference_item",
    "chain.requirements": "chain.requirements[]", "chain": "reference_item",
}
"""Lists: the part of their items."""
LIST_ORDERS: Mapping[str, str] = {
    "component_requirements": "gathered", "core_list": "free", "declared_of": "free", "files": "gathered",
    "group_components": "free", "key_paths": "free", "link_ends": "free", "node_kinds": "free", "open_sets": "gathered",
    "owners": "headed", "port_conditions.*": "free", "port_list": "free", "references": "free",
    "requirement_ids": "gathered", "requirement_parents": "gathered", "reviewers": "gathered",
    "shared_topics": "gathered", "tags": "gathered", "listed_texts": "free", "topic_names": "free",
    "verifications": "gathered", "review.backends": "gathered", "review.passes": "gathered", "accepted": "gathered",
    "requirement.parent": "gathered", "requirement.verified_by": "gathered", "requirement.use_cases": "gathered",
    "property_declaration.choices": "free", "input.from": "free", "input": "free", "parameter.choices": "free",
    "parameter_declaration.choices": "free", "node.implements": "free", "node": "free", "topic_use": "free",
    "link.connects": "free", "link": "free", "start.after": "free", "start": "free", "trigger": "free",
    "chain.requirements": "gathered",
}
"""Lists whose order says nothing. `gathered`: both sides may begin one; `headed`: the first item says more."""
BARE_PARTS: frozenset[str] = frozenset({
    "core_list[]", "count", "flag", "index", "port_number", "promised_limit", "range_limit", "report.large_paper",
    "slice.archgen", "timing_calls.*", "version_digits", "view.depth",
})
"""Values that are no text."""
DATA_PARTS: frozenset[str] = frozenset({
    "component_node.parameters", "container.parameters", "generate.backends", "hints", "node.parameters", "parameter",
    "port_conditions", "ros_parameters",
})
"""What other programs read: it stays as it was written, whatever its keys are called."""
OFFERS: Mapping[str, tuple[str, ...]] = {
    "chapters": ("chapters",), "component_requirements": ("requirements",),
    "component_type_item": ("component_type_names",), "component_type_name": ("component_type_names",),
    "field_type": ("types",), "group_components": ("implemented",), "message_part": ("types",), "owners": ("partners",),
    "port_list": ("inputs",), "tags": ("tags",), "topic_names": ("topics",), "type_name": ("types",),
    "project.middleware": ("media",), "milestone.needs": ("selectors",), "ros.distro": ("distros",),
    "variant.of": ("variants",), "variant.without": ("selectors",), "step.from": ("step_ends",),
    "step.to": ("step_ends",), "requirement.parent": ("requirements",),
    "requirement.verified_by": ("use_cases", "chains"), "requirement.use_cases": ("use_cases",),
    "view.show": ("selectors",), "view": ("selectors",), "component_node.container": ("containers",),
    "component_node.host": ("hosts",), "input.from": ("sources",), "input.medium": ("media",),
    "input.frame": ("frames",), "input": ("sources",), "output.medium": ("media",), "output.frame": ("frames",),
    "output": ("types",), "type_input.medium": ("media",), "type_input.frame": ("frames",),
    "operation.request": ("types",), "operation.response": ("types",), "operation": ("types",),
    "type.message": ("topic_messages", "call_messages"), "type.frame": ("frames",),
    "type": ("topic_messages", "call_messages"), "field": ("types",), "frame.parent": ("frames",),
    "frame.by": ("implemented",), "frame": ("frames",), "promise.frame": ("frames",),
    "node.implements": ("implemented",), "node.container": ("containers",), "node.host": ("hosts",),
    "node": ("implemented",), "topic_use.message": ("topic_messages",), "topic_use": ("topics",),
    "call_use.message": ("call_messages",), "container.host": ("hosts",), "container": ("hosts",),
    "resource.host": ("hosts",), "resource": ("hosts",), "link.connects": ("hosts", "implemented"),
    "link.protocol": ("media",), "link.owner": ("partners",), "link": ("hosts", "implemented"),
    "start.after": ("startable",), "start.by": ("startable",), "start": ("startable",), "require.of": ("selectors",),
    "require.inputs_from": ("selectors",), "forbid.from": ("selectors",), "forbid.to": ("selectors",),
    "trigger": ("inputs",), "chain.through": ("waypoints",), "chain.requirements": ("requirements",),
    "chain": ("waypoints",),
}
"""Which names of a project fit at a part."""
COMMON_SECTIONS: frozenset[str] = frozenset({
    "frames", "generate", "glossary", "libraries", "properties", "variants",
})
"""Sections that files of other programs may have, too."""
WORDS: Mapping[str, tuple[str, ...]] = {
    "autoconnect": ("ports", "types"), "behaviour": ("periodic", "event", "on_demand", "once"),
    "code_language": ("python", "cpp"),
    "declared_of[]": ("partner", "milestone", "use_case", "requirement", "view", "group", "component", "component_type", "input", "output", "type", "frame", "node", "host", "container", "resource", "link", "policy", "chain"),
    "direction": ("left-right", "top-bottom"), "dropped": ("kept", "forgotten"),
    "level": ("functional", "implementation"),
    "node_kind_item": ("node", "lifecycle", "composable", "driver", "nodelet", "program"),
    "node_status": ("planned", "existing", "adapted"), "qos_durability": ("volatile", "transient_local"),
    "qos_history": ("keep_last", "keep_all"), "qos_liveliness": ("automatic", "manual_by_topic"),
    "qos_profile": ("default", "sensor_data", "services", "parameters", "parameter_events", "system_default"),
    "qos_reliability": ("reliable", "best_effort"), "role": ("source", "filter", "sink", "reactive"),
    "severity": ("note", "off", "warning", "error"), "start_phase": ("network", "simulators", "core", "components"),
    "start_state": ("unconfigured", "inactive", "active"), "status": ("planned", "existing"),
    "visibility": ("public", "protected", "private"), "ros.discovery": ("subnet", "peers", "server"),
    "report.lists[]": ("figures", "tables"),
    "property_declaration.type": ("boolean", "integer", "float", "string", "date"),
    "view.colour": ("group", "owner", "role", "status", "host", "package", "tag"),
    "operation.call": ("synchronous", "asynchronous"),
    "parameter_declaration.type": ("boolean", "integer", "float", "string", "boolean[]", "integer[]", "float[]", "string[]"),
    "timing_input.stored": ("at_once",), "timing_input.memory": ("each_source",),
}
"""The words of which one stands at a part."""
PART_TYPES: Mapping[str, str] = {
    "project.middleware": "medium", "milestone.needs": "text", "review.backends": "texts", "review.passes": "texts",
    "variant.of": "variant_ids", "variant.without": "text", "step.from": "step_end", "step.to": "step_end",
    "requirement.parent": "requirement_parents", "requirement.verified_by": "verifications",
    "requirement.use_cases": "requirement_ids", "view.show": "text", "component_node.container": "id",
    "component_node.host": "id", "input.from": "references", "input.medium": "medium", "input.frame": "frame_name",
    "output.medium": "medium", "output.frame": "frame_name", "type_input.medium": "medium",
    "type_input.frame": "frame_name", "operation.request": "operation_fields", "operation.response": "operation_fields",
    "type.message": "message", "type.frame": "frame_name", "frame.parent": "frame_name", "frame.by": "frame_writer",
    "promise.frame": "frame_name", "node.implements": "references", "node.container": "id", "node.host": "id",
    "topic_use.message": "message", "call_use.message": "message", "container.host": "id", "resource.host": "id",
    "link.connects": "link_ends", "link.protocol": "medium", "link.owner": "id", "start.after": "references",
    "start.by": "start_manager", "require.of": "text", "require.inputs_from": "text", "forbid.from": "text",
    "forbid.to": "text", "chain.through": "way", "chain.requirements": "requirement_ids",
}
"""The types of the parts that say more than their type."""
ATTRIBUTES: Mapping[str, tuple[str, ...]] = {
    "hints": ("annotations",), "properties": ("annotations",), "report.large_paper": ("has_large_paper",),
    "accepted_difference.rule": ("rules",), "site.repository": ("address",),
    "requirement.parent": ("parents", "parent_at"), "component.is": ("component_type",),
    "component.same_as": ("is_reference",), "component_type.is": ("base",), "component_type.abstract": ("is_abstract",),
    "input.from": ("connections", "from_written"), "input.medium": ("medium", "medium_written"),
    "output.medium": ("medium", "medium_written"), "parameter_declaration.from": ("handed_from",),
    "parameter_declaration.hints": ("hints", "hint_places"), "frame.by": ("by", "by_kind", "by_written"),
    "node.kind": ("kinds",), "host.scheduling": ("scheduling", "core_scheduling", "core_places", "fair"),
    "host.environment": ("environment", "environment_places"), "link.connects": ("connects", "devices", "unresolved"),
    "link.latency": ("best", "worst"), "start.by": ("by", "by_written"),
    "policy.forbid": ("forbid_from", "forbid_to", "from_at", "to_at"),
    "policy.accepted": ("accepted", "accepted_places"), "forbid.from": ("forbid_from",), "forbid.to": ("forbid_to",),
    "timing.wcet": ("wcet", "measured_times"), "timing_input.stored": ("stored_at_once",),
    "chain.through": ("through", "unresolved"), "chain.deadline": ("deadline", "deadline_shares", "deadline_places"),
    "chain.requirements": ("requirements", "requirement_places"),
}
"""The fields of the model that hold what stands at a key, or keys of a type, where they are not called as it."""
PLACED_KEYS: Mapping[str, tuple[str, ...]] = {
    "milestone": ("needs",), "view": ("show",), "component": ("role",), "component_type": ("role",),
    "input": ("medium", "type", "freshness", "frame"), "output": ("type", "medium", "frame"),
    "parameter_declaration": ("value",), "type": ("message", "frame"), "frame": ("parent",),
    "node": ("name", "kind", "command", "container"), "container": ("name",), "link": ("connects", "protocol"),
}
"""Keys whose values keep their places, each in a field `KEY_at`."""
SECTION_KINDS: Mapping[str, str] = {
    "partners": "partner", "use_cases": "use_case", "requirements": "requirement", "properties": "property_declaration",
    "component_types": "component_type", "libraries": "library", "groups": "group", "nodes": "node", "types": "type",
    "hosts": "host", "containers": "container", "resources": "resource", "links": "link", "frames": "frame",
    "chains": "chain", "views": "view", "policies": "policy", "variants": "variant", "milestones": "milestone",
}
"""Sections whose keys are ids of elements: the kind of these."""
LISTED_PARTS: frozenset[str] = frozenset({
    "chain.through", "command", "declared_of", "input.from", "key_paths", "link.connects", "link_ends", "listed_texts",
    "node.implements", "node_kinds", "references", "requirement.parent", "requirement.verified_by",
    "requirement_parents", "review.backends", "review.passes", "start.after", "topic_names", "variant.of",
    "variant_ids", "verifications", "way",
})
"""Lists in whose place a scalar is a list of one."""
SHORT_KEYS: Mapping[str, tuple[str, ...]] = {
    "partner": ("title",), "milestone": ("date",), "variant": ("title",), "library": ("path",), "use_case": ("title",),
    "actor": ("title",), "requirement": ("title",), "property_declaration": ("title",), "view": ("show",),
    "group": ("title",), "component": ("title",), "component_type": ("title",), "input": ("from",), "output": ("type",),
    "type_input": ("type",), "indicator": (), "operation": ("response",), "type": ("message",), "field": ("type",),
    "constant": (), "frame": ("parent",), "node": ("implements",), "topic_use": ("topic",), "call_use": ("name",),
    "qos": ("profile",), "host": ("title",), "container": ("host",), "resource": ("host",), "link": ("connects",),
    "start": ("after",), "start_ready": ("wait",), "policy": (), "latency": ("best", "worst"), "chain": ("through",),
}
"""The keys that a scalar or a list in the place of an element stands for."""
PLAIN_SECTIONS: Mapping[str, str] = {
    "partner": "partners", "use_case": "use_cases", "requirement": "requirements", "host": "hosts",
    "container": "containers", "resource": "resources", "chain": "chains", "milestone": "milestones",
}
"""Kinds of elements that are named by their id alone, not by a path, and their sections."""
DECLARING_KEYS: Mapping[str, tuple[str, ...]] = {
    "milestone": ("date", "needs"), "view": ("show",), "node": ("implements", "kind", "command", "internal"),
    "container": ("host",), "resource": ("host",), "link": ("connects",), "policy": ("forbid", "require"),
    "chain": ("through",),
}
"""Keys of which a new element has one, where any other key only adds to one."""
ANNOTATED_KINDS: tuple[str, ...] = (
    "partner", "milestone", "use_case", "requirement", "view", "group", "component", "component_type", "input",
    "output", "type", "frame", "node", "host", "container", "resource", "link", "policy", "chain",
)
"""Kinds of elements that may have properties and hints."""
OTHER_WORDS: Mapping[str, Mapping[str, str]] = {
    "group": {
        "partner": "owner", "responsible": "owner", "lead": "owner", "maintainer": "owner", "author": "owner",
        "team": "owner", "members": "components", "parts": "components", "modules": "components",
    },
    "component": {
        "purpose": "functionality", "task": "functionality", "does": "functionality", "function": "functionality",
        "partner": "owner", "responsible": "owner", "maintainer": "owner", "author": "owner", "team": "owner",
        "type": "is", "class": "is", "extends": "is", "in": "inputs", "receives": "inputs", "reads": "inputs",
        "consumes": "inputs", "needs": "inputs", "depends": "inputs", "dependencies": "inputs", "depends_on": "inputs",
        "requires": "inputs", "out": "outputs", "sends": "outputs", "produces": "outputs", "emits": "outputs",
        "writes": "outputs",
    },
    "input": {
        "source": "from", "reads": "from", "connect": "from", "connects": "from", "connection": "from",
        "max_age": "freshness", "age": "freshness", "frame_id": "frame",
    },
    "output": {
        "target": "to", "targets": "to", "frame_id": "frame",
    },
    "node": {
        "component": "implements", "components": "implements", "realizes": "implements", "realises": "implements",
        "pkg": "package", "ros_package": "package", "exe": "executable", "exec": "executable", "binary": "executable",
        "script": "executable", "program": "executable", "class": "plugin", "composable": "plugin", "lang": "language",
        "args": "arguments", "params": "parameters", "params_file": "parameter_files",
        "params_files": "parameter_files", "parameter_file": "parameter_files", "config": "parameter_files",
        "ns": "namespace", "machine": "host", "computer": "host", "runs_on": "host", "publishers": "publishes",
        "pub": "publishes", "pubs": "publishes", "publish": "publishes", "subscribers": "subscribes",
        "sub": "subscribes", "subs": "subscribes", "subscribe": "subscribes", "subscriptions": "subscribes",
        "services": "serves", "actions": "serves", "servers": "serves", "provides": "serves",
        "action_servers": "serves", "clients": "calls", "uses": "calls", "service_clients": "calls",
        "action_clients": "calls", "remap": "remaps", "remappings": "remaps",
    },
    "topic_use": {
        "quality": "qos", "qos_profile": "qos",
    },
    "type": {
        "msg": "message", "msg_type": "message", "message_type": "message", "ros_type": "message",
        "ros_message": "message", "service": "message", "srv": "message", "action": "message", "interface": "message",
        "type": "message", "definition": "message", "bytes": "size", "description": "comment", "doc": "comment",
        "goal": "request", "result": "response",
    },
    "qos": {
        "queue": "depth", "queue_size": "depth",
    },
    "timing": {
        "frequency": "rate", "freq": "rate", "hz": "rate", "publish_rate": "rate", "execution_time": "wcet",
        "exec_time": "wcet", "duration": "wcet", "worst_case": "wcet", "worst_case_execution_time": "wcet",
        "runtime": "wcet", "best_case": "bcet", "best_case_execution_time": "bcet", "cpus": "cores",
        "affinity": "cores", "cpu_affinity": "cores", "cpu": "core", "prio": "priority",
    },
    "host": {
        "cpus": "cores", "cpu": "cores", "cpu_cores": "cores", "processors": "cores", "ip": "address",
        "ip_address": "address", "hostname": "address", "name": "title",
    },
    "link": {
        "from": "connects", "to": "connects", "between": "connects", "hosts": "connects", "nodes": "connects",
        "ends": "connects", "endpoints": "connects", "joins": "connects", "speed": "bandwidth", "capacity": "bandwidth",
        "throughput": "bandwidth", "data_rate": "bandwidth", "delay": "latency", "type": "protocol",
        "medium": "protocol", "kind": "protocol",
    },
    "chain": {
        "from": "through", "to": "through", "path": "through", "flow": "through", "steps": "through",
        "elements": "through", "components": "through", "nodes": "through", "via": "through", "hops": "through",
        "route": "through", "latency": "deadline", "max_latency": "deadline", "budget": "deadline", "limit": "deadline",
        "end_to_end": "deadline", "description": "title",
    },
    "partner": {
        "email": "contact", "mail": "contact", "url": "contact", "website": "contact", "github": "reviewers",
        "gitlab": "reviewers", "handle": "reviewers", "handles": "reviewers", "people": "reviewers",
        "members": "reviewers",
    },
    "requirement": {
        "text": "description", "statement": "description", "test": "verified_by", "tests": "verified_by",
        "verification": "verified_by",
    },
}
"""What people call the keys of a kind elsewhere."""
SUPPORTING_KEYS: Mapping[str, tuple[str, ...]] = {
    "component": ("contact", "hints", "image", "layout", "node", "owner", "parameters", "properties", "requirements", "status", "tags", "timing", "urls"),
}
"""Keys that say something of an element that others declare."""
