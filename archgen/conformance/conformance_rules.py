"""The rules about a robot that exists and its design. No project breaks them by itself: `archgen conform` reports them."""

from __future__ import annotations

from archgen.diagnostics import Rule, Severity, read_rules
from archgen.diagnostics.rule_options import RuleOption

RULES = (
    *read_rules("""
error other-type: A topic, service or action of the robot has another type than the design says.
error other-qos: The quality of service of the robot is not what the design writes, or no longer fits the other end.
error other-name: A node of the robot, or what it uses, is there under another name than the design says.
error not-running: The design has a node, or something that a node uses, which the robot has not.
warning not-in-model: The robot has a node, or a node uses something, that the design has not.
error runs-twice: Two nodes of the robot have the same full name.
error other-state: A lifecycle node of the robot is in another state than the one in which the design has it once the robot is up.
warning other-host: A node of the robot runs on another computer than the design says.
error not-latched: A publisher keeps nothing for those who come late, although the design says so (`durability: transient_local`).
error other-frame: Recorded messages are given in another coordinate frame than the design says.
warning other-parameter: A parameter of the robot has another value than the design gives it.
note stale-import: What a slice was imported from changed since then.
warning stale-acceptance: An accepted difference between robot and design is gone, is accepted for longer than was said, or names no rule.
"""),
    Rule(
        "rate-below-promise",
        Severity.ERROR,
        "Messages were recorded at a lower rate than the output promises.",
        options=(RuleOption("margin", 10, 0, 90, "The share by which the measured rate may be lower."),),
    ),
    Rule(
        "gap-above-promise",
        Severity.ERROR,
        "Between two recorded messages lay more time than the output promises.",
        options=(RuleOption("margin", 10, 0, 900, "The share by which the measured gap may be longer."),),
    ),
    Rule(
        "late-first-message",
        Severity.WARNING,
        "The first message came later after the beginning of the recording than the longest gap that the output promises.",
        options=(RuleOption("margin", 10, 0, 900, "The share by which that time may be longer."),),
    ),
    Rule(
        "larger-than-modelled",
        Severity.WARNING,
        "A recorded message is larger than the size of its type in the model.",
        options=(RuleOption("margin", 10, 0, 900, "The share by which a message may be larger."),),
    ),
)
RULE_NAMES = frozenset(rule.name for rule in RULES)
"""The names of these rules: a comment that silences one of them silences nothing in a check."""
