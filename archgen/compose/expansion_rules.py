"""The rules about component types and their instances, with their pages."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Rule, Severity

UNKNOWN_PORT = """An instance writes about a port that its type does not have.

Why: An instance has exactly the ports of its type, so that whoever reads the type knows all of its instances. A port that only one
of them has is nearly always a slip in its name.

Bad:
    component_types:
      camera: {outputs: {image: sensor_msgs/msg/Image}}
    groups:
      sensing:
        components:
          head: {is: camera, outputs: {imgae: {external: The recorder}}}
          screen: {inputs: {image: head.image}}
    nodes: {head: {implements: head}, screen: {implements: screen}}

Good:
    component_types:
      camera: {outputs: {image: sensor_msgs/msg/Image}}
    groups:
      sensing:
        components:
          head: {is: camera, outputs: {image: {external: The recorder}}}
          screen: {inputs: {image: head.image}}
    nodes: {head: {implements: head}, screen: {implements: screen}}
"""

UNKNOWN_COMPONENT = """An instance writes about a component inside that its type does not have.

Why: What is inside of an instance is what its type says. To add a component, make a type from the type (`is`), which may have more.

Bad:
    component_types:
      arm: {components: {motor: {inputs: {speed: {external: The operator}}}}}
    groups:
      body:
        components:
          left: {is: arm, components: {moter: {timing: {rate: 10 Hz}}}}
    nodes: {left_motor: {implements: left.motor}}

Good:
    component_types:
      arm: {components: {motor: {inputs: {speed: {external: The operator}}}}}
    groups:
      body:
        components:
          left: {is: arm, components: {motor: {timing: {rate: 10 Hz}}}}
    nodes: {left_motor: {implements: left.motor}}
"""

CHANGED_REFERENCE = """A reference to a component type (`same_as`) writes what the type decides.

Why: `same_as` promises that this component is exactly the type, today and after each change of it. Its own are only where its inputs
come from, its title, its owner and where it runs. What differs is an instance: `is`.

Bad:
    component_types:
      laser: {outputs: {scan: sensor_msgs/msg/LaserScan}, timing: {rate: 20 Hz}}
    groups:
      sensing:
        components:
          front: {same_as: laser, timing: {rate: 40 Hz}}
          stop: {inputs: {scan: front.scan}}
    nodes: {front: {implements: front}, stop: {implements: stop}}

Good:
    component_types:
      laser: {outputs: {scan: sensor_msgs/msg/LaserScan}, timing: {rate: 20 Hz}}
    groups:
      sensing:
        components:
          front: {is: laser, timing: {rate: 40 Hz}}
          stop: {inputs: {scan: front.scan}}
    nodes: {front: {implements: front}, stop: {implements: stop}}
"""

CIRCULAR_TYPES = """A component type is made from itself, or holds itself.

Why: Written out, it would go on for ever. What is inside of the circle is left out.

Bad:
    component_types:
      cart: {components: {trailer: {is: trailer}}}
      trailer: {components: {cart: {is: cart}}}
    groups:
      yard: {title: Yard, components: {train: {functionality: Pulls.}}}
    nodes: {train: {implements: train}}

Good:
    component_types:
      cart: {components: {trailer: {is: trailer}}}
      trailer: {functionality: Rolls.}
    groups:
      yard: {title: Yard, components: {train: {functionality: Pulls.}}}
    nodes: {train: {implements: train}}
"""

ABSTRACT_TYPE = """A component is an instance of an abstract type.

Why: `abstract: true` says that the type only holds what others share, and that something is missing in it.

Bad:
    component_types:
      arm: {abstract: true, outputs: {state: sensor_msgs/msg/JointState}}
      long_arm: {is: arm, functionality: Reaches the upper shelf.}
    groups:
      body:
        components:
          left: {is: arm}
          screen: {inputs: {state: left.state}}
    nodes: {left: {implements: left}, screen: {implements: screen}}

Good:
    component_types:
      arm: {abstract: true, outputs: {state: sensor_msgs/msg/JointState}}
      long_arm: {is: arm, functionality: Reaches the upper shelf.}
    groups:
      body:
        components:
          left: {is: long_arm}
          screen: {inputs: {state: left.state}}
    nodes: {left: {implements: left}, screen: {implements: screen}}
"""

NARROWER_TYPE = """A type that stands in the place of another has fewer ports.

Why: An instance, or a type made from a type, may say of a component inside that it is of another type. What is around it is connected
to the ports of the first: all of them must be there.

Bad:
    component_types:
      gripper: {inputs: {force: std_msgs/msg/Float64}, outputs: {state: std_msgs/msg/String}}
      hook: {inputs: {force: std_msgs/msg/Float64}}
      arm:
        inputs: {force: std_msgs/msg/Float64}
        components: {tool: {is: gripper, inputs: {force: self.force}}, log: {inputs: {state: tool.state}}}
    groups:
      body:
        components:
          planner: {outputs: {force: std_msgs/msg/Float64}}
          left: {is: arm, inputs: {force: planner.force}, components: {tool: {is: hook}}}
    nodes: {planner: {implements: planner}, left: {implements: left}}

Good:
    component_types:
      gripper: {inputs: {force: std_msgs/msg/Float64}, outputs: {state: std_msgs/msg/String}}
      soft_gripper: {is: gripper, functionality: Never breaks an egg.}
      arm:
        inputs: {force: std_msgs/msg/Float64}
        components: {tool: {is: gripper, inputs: {force: self.force}}, log: {inputs: {state: tool.state}}}
    groups:
      body:
        components:
          planner: {outputs: {force: std_msgs/msg/Float64}}
          left: {is: arm, inputs: {force: planner.force}, components: {tool: {is: soft_gripper}}}
    nodes: {planner: {implements: planner}, left: {implements: left}}
"""

TOO_MANY_ELEMENTS = """Instances inside of instances stand for more components than can be written out.

Why: Types that hold several instances of the next double at each level: thirty levels are a thousand million components. They are
counted before they are written out, and left empty above 100,000.

Bad:
    component_types:
      t0: {functionality: Blinks.}
      t1: {components: {a: {is: t0}, b: {is: t0}, c: {is: t0}, d: {is: t0}, e: {is: t0}, f: {is: t0}, g: {is: t0}, h: {is: t0}}}
      t2: {components: {a: {is: t1}, b: {is: t1}, c: {is: t1}, d: {is: t1}, e: {is: t1}, f: {is: t1}, g: {is: t1}, h: {is: t1}}}
      t3: {components: {a: {is: t2}, b: {is: t2}, c: {is: t2}, d: {is: t2}, e: {is: t2}, f: {is: t2}, g: {is: t2}, h: {is: t2}}}
      t4: {components: {a: {is: t3}, b: {is: t3}, c: {is: t3}, d: {is: t3}, e: {is: t3}, f: {is: t3}, g: {is: t3}, h: {is: t3}}}
      t5: {components: {a: {is: t4}, b: {is: t4}, c: {is: t4}, d: {is: t4}, e: {is: t4}, f: {is: t4}, g: {is: t4}, h: {is: t4}}}
      t6: {components: {a: {is: t5}, b: {is: t5}, c: {is: t5}, d: {is: t5}, e: {is: t5}, f: {is: t5}, g: {is: t5}, h: {is: t5}}}
    groups:
      hall: {title: Hall, components: {wall: {is: t6}}}
    nodes: {wall: {implements: wall}}

Good:
    component_types:
      lamp: {functionality: Blinks.}
    groups:
      hall: {title: Hall, components: {wall: {is: lamp}}}
    nodes: {wall: {implements: wall}}
"""

RULES: tuple[Rule, ...] = (
    Rule("unknown-port", Severity.ERROR, UNKNOWN_PORT, fixed=True),
    Rule("unknown-component", Severity.ERROR, UNKNOWN_COMPONENT, fixed=True),
    Rule("changed-reference", Severity.ERROR, CHANGED_REFERENCE, fixed=True),
    Rule("circular-types", Severity.ERROR, CIRCULAR_TYPES, fixed=True),
    Rule("abstract-type", Severity.ERROR, ABSTRACT_TYPE, fixed=True),
    Rule("narrower-type", Severity.ERROR, NARROWER_TYPE, fixed=True),
    Rule("too-many-elements", Severity.ERROR, TOO_MANY_ELEMENTS, fixed=True),
)
