"""The rules about variants themselves."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Rule, Severity

RULES: tuple[Rule, ...] = (
    Rule(
        "unknown-variant",
        Severity.ERROR,
        """A variant is built on one that the project does not have.

Why: what the other variant would change is missing, and nobody sees it before the robot runs.

Bad:

    groups: {sensing: {components: {lidar: Lidar}}}
    nodes: {lidar: lidar}
    variants:
      indoor: {changes: {nodes: {lidar: {parameters: {range: 10}}}}}
      simulation: {of: [indor]}

Good:

    groups: {sensing: {components: {lidar: Lidar}}}
    nodes: {lidar: lidar}
    variants:
      indoor: {changes: {nodes: {lidar: {parameters: {range: 10}}}}}
      simulation: {of: [indoor]}
""",
        fixed=True,
    ),
    Rule(
        "circular-variant",
        Severity.ERROR,
        """Variants are built on one another in a circle.

Why: each is laid over what it is built on. In a circle none comes first, and what wins is an accident.

Bad:

    groups: {sensing: {components: {lidar: Lidar}}}
    nodes: {lidar: lidar}
    variants:
      indoor: {of: [simulation]}
      simulation: {of: [indoor]}

Good:

    groups: {sensing: {components: {lidar: Lidar}}}
    nodes: {lidar: lidar}
    variants:
      indoor: Indoors
      simulation: {of: [indoor]}
""",
        fixed=True,
    ),
    Rule(
        "missing-variant-part",
        Severity.ERROR,
        """A variant drops a key that is not there, or changes what it takes out.

Why: the key has another name, or moved. What should be gone in the simulator is still there, and its checks judge a robot
that nobody runs.

Bad:

    groups: {sensing: {components: {lidar: Lidar}}}
    nodes: {lidar: {implements: lidar, host: robot_pc}}
    hosts: {robot_pc: {}}
    variants:
      simulation: {drop: [nodes.lidar.hosts]}

Good:

    groups: {sensing: {components: {lidar: Lidar}}}
    nodes: {lidar: {implements: lidar, host: robot_pc}}
    hosts: {robot_pc: {}}
    variants:
      simulation: {drop: [nodes.lidar.host]}
""",
    ),
    Rule(
        "empty-variant-selector",
        Severity.WARNING,
        """A word of a variant's `without` selects nothing.

Why: what should not be there in this variant is there: its tag was renamed, or never written.

Bad:

    groups: {sensing: {components: {lidar: {title: Lidar, tags: [device]}}}}
    nodes: {lidar: lidar}
    variants:
      simulation: {without: "tag:devices"}

Good:

    groups: {sensing: {components: {lidar: {title: Lidar, tags: [device]}}}}
    nodes: {lidar: lidar}
    variants:
      simulation: {without: "tag:device"}
""",
    ),
)
