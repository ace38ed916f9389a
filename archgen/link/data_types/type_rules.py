"""The rules about types with fields, with their pages."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Rule, Severity

_UNKNOWN_FIELD_TYPE = """A field has a type that nobody knows.

Why: a field holds a type of ROS (`float64`, `string<=10`), a conceptual type of the project, or a message; `T[]`, `T[3]` and
`T[<=5]` are arrays of these. A name that is none of them is misspelt, or still to be declared below `types`.

Bad:

    groups:
      driving:
        components:
          odometry: {outputs: {speed: Speed}}
          screen: {inputs: {speed: odometry.speed}}
    nodes: {odometry: {implements: odometry}, screen: {implements: screen}}
    types:
      Speed: {fields: {forwards: double, sideways: flaot64}}

Good:

    ros: {distro: jazzy}
    groups:
      driving:
        components:
          odometry: {outputs: {speed: Speed}}
          screen: {inputs: {speed: odometry.speed}}
    nodes: {odometry: {implements: odometry}, screen: {implements: screen}}
    types:
      Speed: {fields: {forwards: float64, sideways: float64}}
"""

_CIRCULAR_FIELDS = """A type holds itself by its fields.

Why: ROS puts what a field holds into the message, so that such a message has no end. The fields of a circle are left out
until it is cut: by an id, an index, or a third type that holds what both need. A generic type that grows, as an
`Envelope<T>` that holds an `Envelope<Envelope<T>>`, is a circle too.

Bad:

    groups:
      planning:
        components:
          planner: {outputs: {task: Task}}
          screen: {inputs: {task: planner.task}}
    nodes: {planner: {implements: planner}, screen: {implements: screen}}
    types:
      Task: {fields: {id: uint32, parts: "Task[]"}}

Good:

    ros: {distro: jazzy}
    groups:
      planning:
        components:
          planner: {outputs: {task: Task}}
          screen: {inputs: {task: planner.task}}
    nodes: {planner: {implements: planner}, screen: {implements: screen}}
    types:
      Task: {fields: {id: uint32, parts: "uint32[]"}}
"""

_CONFLICTING_MESSAGE = """A type with fields defines no message, or one that is defined elsewhere.

Why: a type with fields is the message `PROJECT_msgs/msg/Name`, called after the words of the type. Where no name of ROS
comes of these words, where two types come to one name, or where a file or ROS itself defines that message already, the
type names another one by `message`.

Bad:

    groups:
      driving:
        components:
          odometry: {outputs: {pose: Robot pose, goal: robot pose}}
          screen: {inputs: {pose: odometry.pose, goal: odometry.goal}}
    nodes: {odometry: {implements: odometry}, screen: {implements: screen}}
    types:
      Robot pose: {fields: {x: float64, y: float64}}
      robot pose: {fields: {x: float64, y: float64, heading: float64}}

Good:

    ros: {distro: jazzy}
    groups:
      driving:
        components:
          odometry: {outputs: {pose: Robot pose, goal: robot pose}}
          screen: {inputs: {pose: odometry.pose, goal: odometry.goal}}
    nodes: {odometry: {implements: odometry}, screen: {implements: screen}}
    types:
      Robot pose: {fields: {x: float64, y: float64}}
      robot pose: {message: robot_msgs/msg/Goal, fields: {x: float64, y: float64, heading: float64}}
"""

_UNBOUND_GENERIC = """A generic type is used without the types that it is made for, or with a wrong number of them.

Why: `Envelope` with `generic: [T]` is a pattern of types and no message by itself: what stands for `T` says what is sent.
A generic component type is bound in the same way, where an instance is made of it: `is: filter<Pose>`.

Bad:

    groups:
      driving:
        components:
          odometry: {outputs: {pose: Envelope}}
          screen: {inputs: {pose: odometry.pose}}
    nodes: {odometry: {implements: odometry}, screen: {implements: screen}}
    types:
      Pose: {fields: {x: float64, y: float64}}
      Envelope: {generic: [T], fields: {sender: string, payload: T}}

Good:

    ros: {distro: jazzy}
    groups:
      driving:
        components:
          odometry: {outputs: {pose: Envelope<Pose>}}
          screen: {inputs: {pose: odometry.pose}}
    nodes: {odometry: {implements: odometry}, screen: {implements: screen}}
    types:
      Pose: {fields: {x: float64, y: float64}}
      Envelope: {generic: [T], fields: {sender: string, payload: T}}
"""

RULES = (
    Rule("unknown-field-type", Severity.ERROR, _UNKNOWN_FIELD_TYPE, fixed=True),
    Rule("circular-fields", Severity.ERROR, _CIRCULAR_FIELDS, fixed=True),
    Rule("conflicting-message", Severity.ERROR, _CONFLICTING_MESSAGE, fixed=True),
    Rule("unbound-generic", Severity.ERROR, _UNBOUND_GENERIC, fixed=True),
)
