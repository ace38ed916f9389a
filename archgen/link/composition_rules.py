"""The rules about components inside of components and what connects them, with their pages."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Rule, Severity

REACHES_OUTSIDE = """Inside of a component type, a reference means something outside of it.

Why: A type may have many instances, in other projects too. What it needs from around it comes in by an input: `self.` and its name.

Bad:
    component_types:
      arm: {components: {motor: {inputs: {speed: planner.speed}}}}
    groups:
      body:
        components:
          planner: {outputs: {speed: std_msgs/msg/Float64}}
          screen: {inputs: {speed: planner.speed}}
          left: {is: arm}
    nodes: {planner: {implements: planner}, screen: {implements: screen}, left: {implements: left}}

Good:
    component_types:
      arm:
        inputs: {speed: std_msgs/msg/Float64}
        components: {motor: {inputs: {speed: self.speed}}}
    groups:
      body:
        components:
          planner: {outputs: {speed: std_msgs/msg/Float64}}
          screen: {inputs: {speed: planner.speed}}
          left: {is: arm, inputs: {speed: planner.speed}}
    nodes: {planner: {implements: planner}, screen: {implements: screen}, left: {implements: left}}
"""

REACHES_INSIDE = """A reference reaches past the ports of a composed component.

Why: Its ports are what its owner keeps stable; what is inside may change without a word. The connection counts, but it should be
given on at a port.

Bad:
    groups:
      sensing:
        components:
          localization:
            components:
              lidar: {outputs: {scan: sensor_msgs/msg/LaserScan}}
      driving:
        components:
          stop: {inputs: {scan: sensing.localization.lidar.scan}}
    nodes: {lidar: {implements: lidar}, stop: {implements: stop}}

Good:
    groups:
      sensing:
        components:
          localization:
            outputs: {scan: {from: lidar.scan}}
            components:
              lidar: {outputs: {scan: sensor_msgs/msg/LaserScan}}
      driving:
        components:
          stop: {inputs: {scan: localization.scan}}
    nodes: {lidar: {implements: lidar}, stop: {implements: stop}}
"""

AMBIGUOUS_CONNECTION = """`autoconnect` could join an input to several outputs.

Why: It joins only where one connection is possible. Where several are, nothing is joined, and `from` says which is meant.

Bad:
    groups:
      sensing:
        autoconnect: types
        components:
          left: {outputs: {scan: sensor_msgs/msg/LaserScan}}
          right: {outputs: {scan: sensor_msgs/msg/LaserScan}}
          stop: {inputs: {scan: {type: sensor_msgs/msg/LaserScan}}}
    nodes: {left: {implements: left}, right: {implements: right}, stop: {implements: stop}}

Good:
    groups:
      sensing:
        autoconnect: types
        components:
          left: {outputs: {scan: sensor_msgs/msg/LaserScan}}
          right: {outputs: {scan: sensor_msgs/msg/LaserScan}}
          stop: {inputs: {scan: {type: sensor_msgs/msg/LaserScan, from: [left.scan, right.scan]}}}
    nodes: {left: {implements: left}, right: {implements: right}, stop: {implements: stop}}
"""

SEVERAL_SOURCES = """`from` of an instance gives one input several outputs.

Why: `from` at an instance gives each of its inputs every output of equal type. Where that is more than one, two streams meet at one
input, which is rarely meant.

Bad:
    component_types:
      stop: {inputs: {scan: sensor_msgs/msg/LaserScan}}
    groups:
      sensing:
        components:
          left: {outputs: {scan: sensor_msgs/msg/LaserScan}}
          right: {outputs: {scan: sensor_msgs/msg/LaserScan}}
          stop: {is: stop, from: [left, right]}
    nodes: {left: {implements: left}, right: {implements: right}, stop: {implements: stop}}

Good:
    component_types:
      stop: {inputs: {scan: sensor_msgs/msg/LaserScan}}
    groups:
      sensing:
        components:
          left: {outputs: {scan: sensor_msgs/msg/LaserScan}}
          right: {outputs: {scan: sensor_msgs/msg/LaserScan}}
          stop: {is: stop, inputs: {scan: [left.scan, right.scan]}}
    nodes: {left: {implements: left}, right: {implements: right}, stop: {implements: stop}}
"""

UNUSED_NODE = """What a component says of its own node is not used, since another node runs it.

Why: A written node that implements a component, or all of what it stands in, decides what runs. `node` at the component is then
read by nobody.

Bad:
    groups:
      driving:
        components:
          base:
            components:
              wheels: {inputs: {speed: {external: The operator}}, node: {package: wheels, executable: wheels}}
    nodes: {base: {implements: base, package: base, executable: base}}

Good:
    groups:
      driving:
        components:
          base:
            components:
              wheels: {inputs: {speed: {external: The operator}}}
    nodes: {base: {implements: base, package: base, executable: base}}
"""

DUPLICATE_PORT = """A composed component has an output and a component inside with one id.

Why: Both would be called `arm.state`: a reference could not tell them apart.

Bad:
    groups:
      body:
        components:
          arm:
            outputs: {state: {from: state.joints}}
            components:
              state: {outputs: {joints: sensor_msgs/msg/JointState}}
          screen: {inputs: {joints: arm.state}}
    nodes: {arm: {implements: body.arm}, screen: {implements: screen}}

Good:
    groups:
      body:
        components:
          arm:
            outputs: {joints: {from: state.joints}}
            components:
              state: {outputs: {joints: sensor_msgs/msg/JointState}}
          screen: {inputs: {joints: arm.joints}}
    nodes: {arm: {implements: arm}, screen: {implements: screen}}
"""

RULES: tuple[Rule, ...] = (
    Rule("reaches-outside", Severity.ERROR, REACHES_OUTSIDE, fixed=True),
    Rule("reaches-inside", Severity.WARNING, REACHES_INSIDE),
    Rule("ambiguous-connection", Severity.WARNING, AMBIGUOUS_CONNECTION),
    Rule("several-sources", Severity.WARNING, SEVERAL_SOURCES),
    Rule("unused-node", Severity.NOTE, UNUSED_NODE),
    Rule("duplicate-port", Severity.ERROR, DUPLICATE_PORT, fixed=True),
)
