"""The rules of reading, for syntax and schema alike: what can be wrong with a file by itself."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Rule, Severity


def _make_fixed_rule(name: str, doc: str) -> Rule:
    return Rule(name, Severity.ERROR, doc, fixed=True)


RULES: tuple[Rule, ...] = (
    _make_fixed_rule(
        "syntax-error",
        """A file is not YAML, or not a text file.

Why: nothing of a file that cannot be parsed is used; the other files are checked all the same. The commonest slip is
text that holds a colon and a blank, or begins with a sign that YAML keeps for itself: quote it.

Bad:

    groups:
      sensing:
        title: Sensing: the eyes of the robot

Good:

    groups:
      sensing:
        title: "Sensing: the eyes of the robot"
""",
    ),
    _make_fixed_rule(
        "merge-conflict",
        """A file holds the markers of a merge that Git could not finish.

Why: neither side of an unfinished merge is what anybody meant, so neither is read.

Bad:

    groups:
    <<<<<<< HEAD
      sensing: Sensing
    =======
      sensing: Perception
    >>>>>>> perception-team

Good:

    groups:
      sensing: Perception
""",
    ),
    _make_fixed_rule(
        "duplicate-key",
        """One mapping has the same key twice.

Why: most YAML readers keep the last one without a word, and what the first one said is lost.

Bad:

    groups:
      sensing: {title: Sensing, title: Perception}

Good:

    groups:
      sensing: {title: Sensing}
""",
    ),
    _make_fixed_rule(
        "recursive-alias",
        """An alias stands inside of the value that it stands for.

Why: such a value has no end.

Bad:

    groups: {driving: {components: {planner: Planner}}}
    nodes:
      planner:
        implements: driving.planner
        parameters:
          limits: &limits [1, *limits]

Good:

    groups: {driving: {components: {planner: Planner}}}
    nodes:
      planner:
        implements: driving.planner
        parameters:
          limits: &limits [1, 2]
          soft_limits: *limits
""",
    ),
    _make_fixed_rule(
        "too-large",
        """A file is larger, deeper or, with its aliases expanded, longer than archgen reads.

Why: no architecture needs it, and a file made to exhaust memory does. The limits are 16 MiB and a million values for
each file, 100,000 values from aliases, and 64 levels.

Bad:

    groups: {driving: {components: {planner: Planner}}}
    nodes:
      planner:
        implements: driving.planner
        parameters:
          a: &a [0, 0, 0, 0, 0, 0, 0, 0, 0, 0]
          b: &b [*a, *a, *a, *a, *a, *a, *a, *a, *a, *a]
          c: &c [*b, *b, *b, *b, *b, *b, *b, *b, *b, *b]
          d: &d [*c, *c, *c, *c, *c, *c, *c, *c, *c, *c]
          e: &e [*d, *d, *d, *d, *d, *d, *d, *d, *d, *d]

Good:

    groups: {driving: {components: {planner: Planner}}}
    nodes:
      planner:
        implements: driving.planner
        parameters:
          a: &a [0, 0, 0, 0, 0, 0, 0, 0, 0, 0]
          b: *a
""",
    ),
    _make_fixed_rule(
        "unknown-key",
        """A key that the language does not have.

Why: what stands below a mistyped key would be ignored, and nobody would notice.

Bad:

    groups:
      sensing:
        titel: Sensing

Good:

    groups:
      sensing:
        title: Sensing
""",
    ),
    _make_fixed_rule(
        "missing-key",
        """An element lacks the key without which it means nothing, in all files of the project.

Why: a view has to say what it shows, a policy what it forbids. Everything else may be written later.

Bad:

    views:
      safety: {title: What stops the robot}

Good:

    groups: {driving: Driving}
    views:
      safety: {title: What stops the robot, show: driving}
""",
    ),
    _make_fixed_rule(
        "wrong-type",
        """A value is of another kind than its key takes: text instead of a mapping, or instead of a number.

Why: a value that was meant otherwise than it is read is worse than none.

Bad:

    groups:
      sensing:
        components:
          camera:
            inputs: light
    nodes: {camera: {implements: sensing.camera}}

Good:

    groups:
      sensing:
        components:
          camera:
            inputs: {light: {external: The room, medium: physical}}
    nodes: {camera: {implements: sensing.camera}}
""",
    ),
    _make_fixed_rule(
        "wrong-value",
        """A value that its key does not take: an unknown word, a quantity without its unit, an id that is none.

Why: quantities have units because 10 may be Hz or ms, and ids have one shape because they become names in ROS, in file
names and in links.

Bad:

    groups: {driving: {components: {planner: Planner}}}
    nodes:
      planner:
        implements: driving.planner
        timing: {rate: 10}

Good:

    groups: {driving: {components: {planner: Planner}}}
    nodes:
      planner:
        implements: driving.planner
        timing: {rate: 10 Hz}
""",
    ),
    Rule(
        "swallowed-text",
        Severity.NOTE,
        """A comment right after plain text looks as if it were meant as a part of the text.

Why: in YAML ` #` begins a comment wherever text is not quoted, so `Camera #2` is `Camera`.

Bad:

    groups:
      sensing:
        title: Camera #2

Good:

    groups:
      sensing:
        title: "Camera #2"
""",
    ),
)
