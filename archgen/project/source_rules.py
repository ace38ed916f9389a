"""The rules about finding a project's files."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Rule, Severity

RULES: tuple[Rule, ...] = (
    Rule(
        "ignored-file",
        Severity.NOTE,
        """A YAML file below the project's folder holds no section of the language and is not read.

Why: where `sources` is left out, every YAML file below is looked at. Parameter files and workflows are not meant. A file
with a slip in its only section is: it is read, and the slip an error, if what stands there has the section's keys. A file
that holds nothing but `frames` may be another program's: it is not read unless `sources` names it, and that is a warning
where it looks like ours.

Bad:

    # file: archgen.yaml
    archgen: 1
    # file: params.yaml
    max_speed: 0.4

Good:

    # file: archgen.yaml
    archgen: 1
    sources: []
    # file: params.yaml
    max_speed: 0.4
""",
    ),
    Rule(
        "missing-library",
        Severity.ERROR,
        """A library that archgen.yaml names cannot be read.

Why: a library is a folder in the same repository, so that each commit has the library that belongs to it, and a pull request
from a stranger reads nothing else. It is reached without links, is not around the project's folder, and has no libraries of
its own; without git it lies below the project's folder. A library without a path cannot be read either; a folder without component
types and types is a warning.

Bad:

    # file: archgen.yaml
    archgen: 1
    libraries: {common: comon}
    # file: common/drivers.yaml
    component_types:
      laser: {outputs: {scan: sensor_msgs/msg/LaserScan}}

Good:

    # file: archgen.yaml
    archgen: 1
    libraries: {common: common}
    # file: common/drivers.yaml
    component_types:
      laser: {outputs: {scan: sensor_msgs/msg/LaserScan}}
""",
        fixed=True,
    ),
    Rule(
        "missing-source",
        Severity.WARNING,
        """A pattern in `sources` or `ros.interfaces` matches no file.

Why: a slip in a pattern would leave out files without a word. Where files are nearly called so, this is an error, and what
they declare is not reported as missing.

Bad:

    ros: {interfaces: ["mgs/*.msg"]}

Good:

    ros: {interfaces: []}
""",
    ),
    Rule(
        "wrong-pass",
        Severity.ERROR,
        """A pass of the project, rules in a file of its folder `passes`, cannot be read or comes to no end.

Why: a rule that names a variable that nothing binds, or a key that there is not, would find and write nothing, and nobody
would see why. One that changes nothing that it finds would find it for ever. Such a pass does not run.

Bad:

    # file: archgen.yaml
    archgen: 1
    # file: passes/tag_cameras.yaml
    title: Tags what sends pictures
    rules:
      - find: {components: {$camera: {outputs: {$port: {type: Picture}}}}}
        unless: {components: {$camera: {tags: [camera]}}}
        add: {components: {$kamera: {tags: [camera]}}}

Good:

    # file: archgen.yaml
    archgen: 1
    # file: passes/tag_cameras.yaml
    title: Tags what sends pictures
    rules:
      - find: {components: {$camera: {outputs: {$port: {type: Picture}}}}}
        unless: {components: {$camera: {tags: [camera]}}}
        add: {components: {$camera: {tags: [camera]}}}
""",
    ),
)
