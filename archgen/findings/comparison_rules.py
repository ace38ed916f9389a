"""The rules about two versions of a project, which no version breaks by itself: reviews report them."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Rule, Severity

BREAKING_CHANGE = Rule(
    "breaking-change",
    Severity.WARNING,
    """\
A change takes something from a partner who does not own what was changed, and nobody accepted that.

Why: Whoever reads an output, uses a message or relies on a deadline has to change or to test the own part again, and should
know before the merge. `archgen review` and `archgen diff` find it by comparing two versions: `Reported` is what the change makes
of `Not reported`. What was agreed is written down as accepted, with the reason, and is not reported. The message names the
category of what is lost (`wire`, `promise`, `meaning`, `source`), and the severity is that of the category.

Bad:
    partners: {north: {title: North}, south: {title: South}}
    groups:
      sensing:
        owner: north
        components:
          camera: {outputs: {image: sensor_msgs/msg/CompressedImage}}
      display:
        owner: south
        components:
          screen: {inputs: {image: camera.image}}

Good:
    partners: {north: {title: North}, south: {title: South}}
    groups:
      sensing:
        owner: north
        components:
          camera: {outputs: {image: sensor_msgs/msg/Image}}
      display:
        owner: south
        components:
          screen: {inputs: {image: camera.image}}
""",
    setting="review: {breaking: {wire: error}}  # off, note, warning or error for each category, or one for all",
)
COMPARISON_RULES = (BREAKING_CHANGE,)
