"""Programs of rclpy, rclcpp, rospy and roscpp are walked through: what each says to ROS, and what cannot be told."""

from __future__ import annotations

from pathlib import Path
from textwrap import dedent

import pytest

from archgen.importers.work_budget import WorkBudget
from archgen.plugins.ros.sources.program_walk import ProgramWalk
from archgen.plugins.ros.sources.source_index import SourceIndex
from archgen.plugins.ros.sources.walk_values import find_unknown, settle, show_value
from tests.property_sizes import try_some


def walk(
    folder: Path, files: dict[str, str], entry: str = "", *, is_ros_1: bool = False, **given: object
) -> tuple[ProgramWalk, SourceIndex]:
    """Walk through the program that the first file is, or through the class or function that `entry` names."""
    paths = []
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(dedent(text), encoding="utf-8")
        paths.append(path)
    index = SourceIndex([(path, path.relative_to(folder).as_posix()) for path in paths], [("my_robot", folder)])
    is_python = paths[0].suffix == ".py"
    code = None if is_python else index.gather_cpp(path for path in paths if path.suffix == ".cpp")
    parameters = {name.replace("__", "."): value for name, value in given.items()}
    made = ProgramWalk(index, code, parameters, WorkBudget(100_000), is_ros_1=is_ros_1)
    if is_python:
        file = index.read_file(paths[0])
        assert file is not None
        made.walk_script(file, entry)
    elif entry:
        assert made.walk_class(entry)
    else:
        made.walk_main()
    return made, index


def tell(made: ProgramWalk) -> list[str]:
    """Return what a program says, a line each: `*` stands for what is not known, `?` for what may not be made."""
    lines = []
    for node in made.nodes:
        lines.append(f"node {show_value(node.name)}" + (" lifecycle" if node.is_lifecycle else ""))
        for each in node.endpoints:
            name = f"{show_value(each.name)}{'?' if each.is_conditional else ''}"
            why = f" ({find_unknown(each.name)})" if not isinstance(settle(each.name), str) else ""
            lines.append(f"{each.use} {each.flow} {name} {each.message}{why}")
        lines += [f"timer {'*' if period is None else f'{period:g}'}" for period in node.periods]
    return lines


def test_rclpy(tmp_path: Path) -> None:
    """Literals, constants, parameters, f-strings, loops, helpers, actions, timers, filters and transforms."""
    made, _ = walk(
        tmp_path,
        {
            "my_robot/driver.py": """
                import rclpy
                import message_filters
                import tf2_ros
                from rclpy.action import ActionServer, ActionClient
                from rclpy.node import Node
                from rclpy.qos import QoSProfile, ReliabilityPolicy, qos_profile_sensor_data
                from sensor_msgs.msg import Image, LaserScan as Scan
                from std_srvs.srv import Trigger
                from nav2_msgs.action import Spin
                from .helper import Watcher, make_name
                from . import names

                PREFIX = "front"

                class Base(Node):
                    def __init__(self, name):
                        super().__init__(name)
                        self.create_client(Trigger, "base/reset")

                class Driver(Base):
                    RATE = 20.0
                    def __init__(self):
                        super().__init__("driver")
                        self.declare_parameter("topic", "scan")
                        topic = self.get_parameter("topic").get_parameter_value().string_value
                        qos = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
                        self.pub = self.create_publisher(Scan, topic, qos)
                        for side in ("left", "right"):
                            self.create_subscription(Image, f"{PREFIX}/{side}/image", self.on_image, qos_profile_sensor_data)
                        self.create_service(Trigger, names.STOP, self.stop)
                        self.server = ActionServer(self, Spin, make_name("spin"), self.spin)
                        self.client = ActionClient(self, Spin, action_name="/other/spin")
                        self.filtered = message_filters.Subscriber(self, Image, "depth")
                        self.broadcaster = tf2_ros.TransformBroadcaster(self)
                        self.watcher = Watcher(self, "watch")
                        self.create_timer(1.0 / self.RATE, self.tick)

                    def on_image(self, message):
                        self.create_publisher(Scan, message.topic, 1)

                    def unused(self):
                        self.create_publisher(Scan, "never", 1)

                def main():
                    rclpy.init()
                    rclpy.spin(Driver())
            """,
            "my_robot/helper.py": """
                from std_msgs.msg import String

                def make_name(word):
                    return "%s_%s" % ("my", word)

                class Watcher:
                    def __init__(self, node, name):
                        self._node = node
                        self._pub = node.create_publisher(String, name + "/state", 10)
            """,
            "my_robot/names.py": "STOP = '~/stop'\n",
        },
        "main",
        topic="/lidar/scan",
    )
    assert tell(made) == [
        "node driver",
        "calls service base/reset std_srvs/srv/Trigger",
        "publishes topic /lidar/scan sensor_msgs/msg/LaserScan",
        "subscribes topic front/left/image sensor_msgs/msg/Image",
        "subscribes topic front/right/image sensor_msgs/msg/Image",
        "serves service ~/stop std_srvs/srv/Trigger",
        "serves action my_spin nav2_msgs/action/Spin",
        "calls action /other/spin nav2_msgs/action/Spin",
        "subscribes topic depth sensor_msgs/msg/Image",
        "publishes topic /tf tf2_msgs/msg/TFMessage",
        "publishes topic watch/state std_msgs/msg/String",
        "publishes topic * sensor_msgs/msg/LaserScan (message.topic)",
        "timer 0.05",
    ]
    qos = {show_value(each.name): each.qos for each in made.nodes[0].endpoints}
    assert qos["/lidar/scan"] == {"depth": 5, "reliability": "best_effort"}
    assert qos["front/left/image"] == {"profile": "sensor_data"}


def test_rclpy_conditions(tmp_path: Path) -> None:
    """A condition on a parameter is decided by what it is set to; of one that is not known both ways may be."""
    text = """
        import rclpy, os
        from std_msgs.msg import String, Int8

        def main():
            node = rclpy.create_node("chooser")
            node.declare_parameter("debug", False)
            if node.get_parameter("debug").value:
                node.create_publisher(String, "debug", 1)
            name = "day" if os.path.exists("/sun") else "night"
            node.create_publisher(String, name, 1)
            if os.path.exists("/moon"):
                node.create_publisher(Int8, "moon", 1)
            else:
                target = "sky"
                node.create_publisher(String, target, 1)
            node.create_publisher(String, node.declare_parameter("unset").value, 1)
            for word in ("a", "b"):
                if word == "a":
                    setattr(node, word, "first")
                    continue
                node.create_publisher(String, word, 1)
            try:
                node.create_publisher(String, "tried", 1)
            except ValueError:
                return
            node.create_publisher(String, "after", 1)
    """
    made, _ = walk(tmp_path, {"chooser.py": text}, "main")
    assert tell(made) == [
        "node chooser",
        "publishes topic * std_msgs/msg/String (one of day, night)",
        "publishes topic moon? std_msgs/msg/Int8",
        "publishes topic sky? std_msgs/msg/String",
        "publishes topic * std_msgs/msg/String (the parameter unset)",
        "publishes topic b std_msgs/msg/String",
        "publishes topic tried std_msgs/msg/String",
        "publishes topic after std_msgs/msg/String",
    ]
    made, _ = walk(tmp_path, {"chooser.py": text}, "main", debug=True, unset="/set")
    assert "publishes topic debug std_msgs/msg/String" in tell(made)
    assert "publishes topic /set std_msgs/msg/String" in tell(made)


def test_rospy(tmp_path: Path) -> None:
    """A process is one node; private names, parameters and actions as ROS 1 has them."""
    made, _ = walk(
        tmp_path,
        {
            "node.py": """
                import rospy, actionlib
                from geometry_msgs.msg import Twist
                from std_srvs.srv import SetBool
                from move_base_msgs.msg import MoveBaseAction

                class Drive(object):
                    def __init__(self):
                        self.pub = rospy.Publisher("~speed", Twist, queue_size=1)
                        rospy.Subscriber(rospy.get_param("~topic", "cmd_vel"), Twist, self.drive)
                        self.call = rospy.ServiceProxy("/motors", SetBool)
                        self.action = actionlib.SimpleActionClient("move_base", MoveBaseAction)
                        rospy.Timer(rospy.Duration(0.1), self.tick)

                if __name__ == "__main__":
                    rospy.init_node("drive")
                    Drive()
                    rospy.spin()
            """
        },
        is_ros_1=True,
    )
    assert tell(made) == [
        "node drive",
        "publishes topic ~/speed geometry_msgs/msg/Twist",
        "subscribes topic cmd_vel geometry_msgs/msg/Twist",
        "calls service /motors std_srvs/srv/SetBool",
        "calls action move_base move_base_msgs/action/MoveBase",
        "timer 0.1",
    ]


RCLCPP_HEADER = """
    #pragma once
    #include <rclcpp/rclcpp.hpp>
    namespace my_robot {
    using std_srvs::srv::Trigger;
    class Scanner : public rclcpp_lifecycle::LifecycleNode {
    public:
      explicit Scanner(const rclcpp::NodeOptions & options = rclcpp::NodeOptions());
      CallbackReturn on_configure(const State &) override;
    private:
      using Scan = sensor_msgs::msg::LaserScan;
      void on_scan(Scan::ConstSharedPtr message);
      template <typename T> void add(const std::string & name) { create_publisher<T>(name + "/out", 1); }
      std::string topic_{"scan"};
      double rate_ = 10.0;
      std::unique_ptr<Helper> helper_;
      message_filters::Subscriber<sensor_msgs::msg::Image> image_;
      std::shared_ptr<tf2_ros::TransformListener> listener_;
    };
    }
"""
RCLCPP_SOURCE = """
    #include "my_robot/scanner.hpp"
    #include "my_robot/helper.hpp"
    #define STOP "stop"
    namespace my_robot {
    using namespace std::chrono_literals;
    Scanner::Scanner(const rclcpp::NodeOptions & options) : rclcpp_lifecycle::LifecycleNode("scanner", options) {
      this->declare_parameter<std::string>("topic", topic_);
      get_parameter("topic", topic_);
      char text[] = "analog00";
      snprintf(text, 9, "analog%02d", 3);
      create_publisher<Scan>(text, 1);
    }
    CallbackReturn Scanner::on_configure(const State &) {
      create_subscription<Scan>(topic_, rclcpp::SensorDataQoS(), std::bind(&Scanner::on_scan, this, _1));
      auto timer = create_wall_timer(500ms, [this]() { create_client<Trigger>("later"); });
      create_service<Trigger>(STOP, [](auto request, auto response) {});
      helper_ = std::make_unique<Helper>(shared_from_this());
      add<std_msgs::msg::String>("left");
      image_.subscribe(reinterpret_cast<rclcpp::Node*>(this), "image", rmw_qos_profile_sensor_data);
      listener_ = std::make_shared<tf2_ros::TransformListener>(*buffer_);
      rclcpp_action::create_server<nav2_msgs::action::Spin>(this, "spin", a, b, c);
      auto qos = rclcpp::QoS(rclcpp::KeepLast(5)).transient_local().reliable();
      create_publisher<nav_msgs::msg::OccupancyGrid>("map", qos);
      return CallbackReturn::SUCCESS;
    }
    void Scanner::on_scan(Scan::ConstSharedPtr message) {}
    }
    RCLCPP_COMPONENTS_REGISTER_NODE(my_robot::Scanner)
"""
HELPER = """
    class Helper {
    public:
      explicit Helper(rclcpp::Node::SharedPtr node) : node_(node) {
        for (const auto & name : {"a", "b"}) {
          node_->create_publisher<std_msgs::msg::String>(std::string("helper/") + name, 10);
        }
      }
    private:
      rclcpp::Node::SharedPtr node_;
    };
"""


def test_rclcpp(tmp_path: Path) -> None:
    """Header and source are one class; aliases, templates, helpers, components, hooks; what is written into is unknown."""
    pytest.importorskip("tree_sitter_cpp")
    files = {
        "src/scanner.cpp": RCLCPP_SOURCE,
        "include/my_robot/scanner.hpp": RCLCPP_HEADER,
        "include/my_robot/helper.hpp": HELPER,
    }
    made, _ = walk(tmp_path, files, "my_robot::Scanner", topic="/front/scan")
    assert tell(made) == [
        "node scanner lifecycle",
        'publishes topic * sensor_msgs/msg/LaserScan (snprintf(text, 9, "analog%02d", 3))',
        "subscribes topic /front/scan sensor_msgs/msg/LaserScan",
        "serves service stop std_srvs/srv/Trigger",
        "publishes topic helper/a std_msgs/msg/String",
        "publishes topic helper/b std_msgs/msg/String",
        "publishes topic left/out std_msgs/msg/String",
        "subscribes topic image sensor_msgs/msg/Image",
        "subscribes topic /tf tf2_msgs/msg/TFMessage",
        "subscribes topic /tf_static tf2_msgs/msg/TFMessage",
        "serves action spin nav2_msgs/action/Spin",
        "publishes topic map nav_msgs/msg/OccupancyGrid",
        "calls service later std_srvs/srv/Trigger",
        "timer 0.5",
    ]
    qos = {show_value(each.name): each.qos for each in made.nodes[0].endpoints}
    assert qos["map"] == {"depth": 5, "durability": "transient_local", "reliability": "reliable"}
    assert qos["/front/scan"] == {"profile": "sensor_data"}


def test_roscpp(tmp_path: Path) -> None:
    """Node handles and what they add to names; types of callbacks; image transport."""
    pytest.importorskip("tree_sitter_cpp")
    made, _ = walk(
        tmp_path,
        {
            "src/node.cpp": """
                #include <ros/ros.h>
                class Drive {
                public:
                  Drive() : private_("~"), it_(nh_) {
                    std::string name;
                    private_.param<std::string>("topic", name, "cmd_vel");
                    sub_ = nh_.subscribe(name, 1, &Drive::onSpeed, this);
                    pub_ = private_.advertise<nav_msgs::Odometry>("odom", 1);
                    ros::NodeHandle inner(nh_, "front");
                    inner.serviceClient<std_srvs::Trigger>("stop");
                    srv_ = nh_.advertiseService("reset", &Drive::onReset, this);
                    it_.advertiseCamera("camera/image", 1);
                    timer_ = nh_.createTimer(ros::Duration(0.25), &Drive::tick, this);
                  }
                  void onSpeed(const geometry_msgs::Twist::ConstPtr& message) {}
                  bool onReset(std_srvs::Empty::Request& request, std_srvs::Empty::Response& response) { return true; }
                  void tick(const ros::TimerEvent&) {}
                private:
                  ros::NodeHandle nh_, private_;
                  image_transport::ImageTransport it_;
                };
                int main(int argc, char** argv) {
                  ros::init(argc, argv, "drive");
                  Drive drive;
                  ros::spin();
                }
            """
        },
        is_ros_1=True,
    )
    assert tell(made) == [
        "node drive",
        "subscribes topic cmd_vel geometry_msgs/msg/Twist",
        "publishes topic ~/odom nav_msgs/msg/Odometry",
        "calls service front/stop std_srvs/srv/Trigger",
        "serves service reset std_srvs/srv/Empty",
        "publishes topic camera/image sensor_msgs/msg/Image",
        "publishes topic camera/camera_info sensor_msgs/msg/CameraInfo",
        "timer 0.25",
    ]


def test_several_nodes_of_one_process(tmp_path: Path) -> None:
    """Each node object is a node; who is handed one speaks through it."""
    pytest.importorskip("tree_sitter_cpp")
    made, _ = walk(
        tmp_path,
        {
            "main.cpp": """
                class Other : public rclcpp::Node {
                public:
                  explicit Other(std::shared_ptr<rclcpp::Node> & parent) : Node("other", rclcpp::NodeOptions()) {
                    create_publisher<std_msgs::msg::String>("mine", 1);
                    parent->create_publisher<std_msgs::msg::String>("yours", 1);
                  }
                };
                int main() {
                  auto first = std::make_shared<rclcpp::Node>("first");
                  rclcpp::spin(std::make_shared<Other>(first));
                }
            """
        },
    )
    assert tell(made) == [
        "node first",
        "publishes topic yours std_msgs/msg/String",
        "node other",
        "publishes topic mine std_msgs/msg/String",
    ]


HOSTILE = {
    "deep.py": "x = " + "-" * 5000 + "1\n",
    "brackets.py": "x = " + "(" * 5000 + ")" * 5000 + "\n",
    "python2.py": "print 'hello'\n",
    "null.py": "x = 1\0\n",
    "recursion.py": "def f(n):\n    return f(n)\n\nf(1)\n",
    "growth.py": "x = 'a'\n" + "x = x + x\n" * 60,
    "times.py": "x = 'a' * 10**9\ny = [0] * 10**9\n",
    "sums.py": "x = " + "+".join(["'a'"] * 3000) + "\n",
    "loops.py": "a = list(range(10**9))\n"
    + "".join("    " * d + f"for i{d} in range(60):\n" for d in range(6))
    + "    " * 6
    + "print(1)\n",
    "base.py": "class A(B):\n    pass\nclass B(A):\n    def __init__(self):\n        super().__init__()\nA()\n",
    "import.py": "from import_too import *\nimport nothing.at.all\nprint(x)\n",
    "import_too.py": "import os as x\nfrom . import *\n",
    "deep.cpp": "int main() { return " + "(" * 20000 + "1" + ")" * 20000 + "; }",
    "blocks.cpp": "int main() " + "{" * 20000 + "}" * 20000,
    "broken.cpp": "class A : public { int main( { ros::NodeHandle n; n.advertise<",
    "types.cpp": "using A = B; using B = A; A a; int main() { A b; auto c = std::make_shared<A>(); }",
    "self.cpp": "struct A { A a; A() : A(1) {} A(int x) : A() {} }; int main() { A a; }",
    "bytes.cpp": "\ufeff\0int main() {}",
}


@pytest.mark.parametrize("name", try_some(HOSTILE, 9))
def test_hostile_sources(tmp_path: Path, name: str) -> None:
    """Sources that are broken, deep or endless cost little, and what cannot be read is said."""
    if name.endswith(".cpp"):
        pytest.importorskip("tree_sitter_cpp")
    others = {key: text for key, text in HOSTILE.items() if name.startswith("import") and key.startswith("import")}
    made, index = walk(tmp_path, {name: HOSTILE[name], **others}, is_ros_1=name == "broken.cpp")
    # How long a sum Python's parser reads depends on its version.
    unread = [reason for file in index.list_read_files() for _, _, reason in file.unread]
    assert name == "sums.py" or bool(unread) == (name in {"brackets.py", "python2.py", "null.py", "deep.py"}), unread
    assert all(each.name is not None for node in made.nodes for each in node.endpoints)


def test_format_strings_of_newer_pythons_are_read(tmp_path: Path) -> None:
    """Since Python 3.12 there may be lines and the same quotes in their braces; nothing else of the file moves."""
    made, index = walk(
        tmp_path,
        {
            "newer.py": """
                import rclpy  # it's "newer"
                from rclpy.node import Node
                from std_msgs.msg import String
                class Newer(Node):
                    '''Its "doc".'''
                    def __init__(self):
                        names = {"a": "here"}
                        super().__init__(f'newer{
                            1}')
                        self.create_publisher(String, f"/{names["a"]}/{{x}}"[:5], 10)
                        self.create_publisher(String, rf"/there{"}"[1:]}", 10)
                        print(f"{1.5:>{len("abc")}.1f}" 'it''s', "{")
                        self.create_subscription(String, "/now", print, 10)
                rclpy.init()
                Newer()
            """
        },
    )
    assert [file.unread for file in index.list_read_files()] == [[]]
    assert tell(made)[0] == "node newer1"
    assert [each.span.line for each in made.nodes[0].endpoints] == [11, 12, 14]
    assert "subscribes topic /now std_msgs/msg/String" in tell(made)


def test_a_method_called_as_one_of_rclcpp_is_the_programs_own(tmp_path: Path) -> None:
    """As lights of the TurtleBot 4 are made: in a map, by a method that takes the node."""
    made, _ = walk(
        tmp_path,
        {
            "main.cpp": """
            #include <rclcpp/rclcpp.hpp>
            class Led {
            public:
              void create_subscription(rclcpp::Node::SharedPtr nh, std::string topic) {
                sub_ = nh->create_subscription<std_msgs::msg::Int32>(topic, 10, std::bind(&Led::take, this));
              }
            };
            class Leds : public rclcpp::Node {
            public:
              Leds() : Node("leds") {
                std::map<int, std::unique_ptr<Led>> leds_;
                leds_[POWER]->create_subscription(shared_from_this(), "led/power");
                leds_[WIFI]->create_subscription(shared_from_this(), "led/wifi");
              }
            };
            int main() { rclcpp::spin(std::make_shared<Leds>()); }
            """
        },
    )
    assert tell(made) == [
        "node leds",
        "subscribes topic led/power std_msgs/msg/Int32",
        "subscribes topic led/wifi std_msgs/msg/Int32",
    ]


def test_a_service_of_roscpp_is_that_of_its_request(tmp_path: Path) -> None:
    made, _ = walk(
        tmp_path,
        {
            "main.cpp": """
            #include <ros/ros.h>
            bool first(std_srvs::TriggerRequest& request, std_srvs::TriggerResponse& response) { return true; }
            bool second(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) { return true; }
            int main(int argc, char** argv) {
              ros::init(argc, argv, "server");
              ros::NodeHandle nh;
              auto one = nh.advertiseService("one", first);
              auto two = nh.advertiseService("two", &second);
            }
            """
        },
        is_ros_1=True,
    )
    assert tell(made)[1:] == ["serves service one std_srvs/srv/Trigger", "serves service two std_srvs/srv/SetBool"]


def test_modules_beside_the_script_and_classes_in_classes(tmp_path: Path) -> None:
    """A module in a folder imports another one as the script would; a class that is defined in another one is made by both names."""
    made, _ = walk(
        tmp_path,
        {
            "scripts/run.py": """
                import rospy
                from parts.lift import Lift
                if __name__ == "__main__":
                    rospy.init_node("lift")
                    Lift()
            """,
            "scripts/parts/lift.py": """
                import rospy
                from std_msgs.msg import Int8
                from parts.base import Base

                class Lift(Base):
                    def __init__(self):
                        super().__init__()
                        self.up = Lift.Axis("up")
                        self.down = self.Axis("down")
                        self.lost = Axis("lost")

                    class Axis:
                        def __init__(self, name):
                            rospy.Subscriber(name, Int8, self.take)

                        def take(self, message):
                            pass
            """,
            "scripts/parts/base.py": """
                import rospy
                from std_msgs.msg import Int8

                class Base:
                    def __init__(self):
                        rospy.Publisher("base", Int8, queue_size=1)
            """,
        },
        is_ros_1=True,
    )
    assert tell(made) == [
        "node lift",
        "publishes topic base std_msgs/msg/Int8",
        "subscribes topic up std_msgs/msg/Int8",
        "subscribes topic down std_msgs/msg/Int8",
    ]


def test_other_middlewares_subscribe_too(tmp_path: Path) -> None:
    """A client of MQTT is no node handle; one whose type nobody tells may be; actions of C++ have their type in brackets."""
    made, _ = walk(
        tmp_path,
        {
            "main.cpp": """
            #include <ros/ros.h>
            std::shared_ptr<mqtt::client> client;
            actionlib::SimpleActionClient<mbf_msgs::ExePathAction>* action;
            void take(const std_msgs::String& message) {}
            int main(int argc, char** argv) {
              ros::init(argc, argv, "link");
              client = std::make_shared<mqtt::client>("tcp://here", "link");
              client->subscribe("/far", 0);
              action = new actionlib::SimpleActionClient<mbf_msgs::ExePathAction>("exe_path");
              find_handle(1, 2)->subscribe("near", 0, take);
            }
            """
        },
        is_ros_1=True,
    )
    assert tell(made)[1:] == [
        "calls action exe_path mbf_msgs/action/ExePath",
        "subscribes topic *near std_msgs/msg/String (find_handle(1, 2))",
    ]


def test_texts_are_formatted_and_members_named(tmp_path: Path) -> None:
    made, _ = walk(
        tmp_path,
        {
            "main.cpp": """
            #include <rclcpp/rclcpp.hpp>
            struct Pair { rclcpp::PublisherBase::SharedPtr out, in; };
            class Link : public rclcpp::Node {
            public:
              Link() : Node("link") {
                std::string const name = declare_parameter("name", "left");
                pairs_.emplace(name, Pair{
                  .out = create_publisher<std_msgs::msg::Int8>(std::format("{}/out", name), 1),
                  .in = create_subscription<std_msgs::msg::Int8>(fmt::format("{}/in{:d}", name, 3), 1, take),
                });
              }
            };
            int main() { rclcpp::spin(std::make_shared<Link>()); }
            """
        },
    )
    assert tell(made) == [
        "node link",
        "publishes topic left/out std_msgs/msg/Int8",
        'subscribes topic * std_msgs/msg/Int8 (fmt::format("{}/in{:d}", name, 3))',
    ]


def test_comprehensions_are_loops(tmp_path: Path) -> None:
    """With conditions, in one another, as tables and generators; over what is not known they are walked through once."""
    made, _ = walk(
        tmp_path,
        {
            "main.py": """
                import rospy
                from std_msgs.msg import Int8
                from std_srvs.srv import Trigger

                def publish(name):
                    return rospy.Publisher(name, Int8, queue_size=1)

                rospy.init_node("many")
                sides = ["left", "right", ""]
                publishers = [publish(side) for side in sides if side != ""]
                both = [publish(f"{side}/{part}") for side in sides if side for part in ("a", "b")]
                clients = {side: rospy.ServiceProxy(f"{side}/go", Trigger) for side in {"up": 1}}
                all_of = tuple(publish(name + "/x") for name in {each + "1": each for each in sides[:1] or ["up"]})
                some = [publish(f"some/{each}") for each in open("/x")]
                few = [publish(f"few/{each}") for each in ("a", "b") if open("/x")]
                for each in few:
                    publish("late")
            """
        },
        is_ros_1=True,
    )
    assert tell(made)[1:] == [
        "publishes topic left std_msgs/msg/Int8",
        "publishes topic right std_msgs/msg/Int8",
        "publishes topic left/a std_msgs/msg/Int8",
        "publishes topic left/b std_msgs/msg/Int8",
        "publishes topic right/a std_msgs/msg/Int8",
        "publishes topic right/b std_msgs/msg/Int8",
        "calls service up/go std_srvs/srv/Trigger",
        'publishes topic */x? std_msgs/msg/Int8 ({each + "1": each for each in sides[:1] or ["up"]})',
        'publishes topic some/*? std_msgs/msg/Int8 (open("/x"))',
        "publishes topic few/a? std_msgs/msg/Int8",
        "publishes topic few/b? std_msgs/msg/Int8",
        "publishes topic late? std_msgs/msg/Int8",
    ]


def test_classes_that_a_base_lists_are_made(tmp_path: Path) -> None:
    """A node that makes all subclasses of a base, as they were imported, and sets itself into them by name."""
    made, _ = walk(
        tmp_path,
        {
            "my_robot/main.py": """
                import rclpy
                from rclpy.node import Node
                from my_robot.part import Part
                from my_robot.parts import *

                def list_all(base):
                    return base.__subclasses__() + [deep for each in base.__subclasses__() for deep in list_all(each)]

                class Robot(Node):
                    def __init__(self):
                        super().__init__("robot")
                        self.__parts = [each() for each in list_all(Part)]
                        for part in self.__parts:
                            part.robot = self
                            self.__setattr__(part.name, part)
                            part.start()
                        self.arm.raise_it()

                def main():
                    rclpy.spin(Robot())
            """,
            "my_robot/part.py": """
                class Part:
                    def __init__(self, name):
                        self.name = name
                    def start(self):
                        pass
            """,
            "my_robot/parts/__init__.py": "from my_robot.parts.arm import Arm\n",
            "my_robot/parts/arm.py": """
                from std_msgs.msg import Int8
                from my_robot.part import Part

                class Arm(Part):
                    def __init__(self):
                        super().__init__("arm")
                    def raise_it(self):
                        self.robot.create_publisher(Int8, "up", 10)

                class Hand(Arm):
                    def start(self):
                        self.robot.create_subscription(Int8, "grip", print, 10)
            """,
            "my_robot/other.py": """
                from my_robot.part import Part
                class Other(Part):
                    def start(self):
                        self.robot.create_publisher(None, "never", 10)
            """,
        },
        "main",
    )
    assert tell(made) == [
        "node robot",
        "subscribes topic grip std_msgs/msg/Int8",
        "publishes topic up std_msgs/msg/Int8",
    ]


@pytest.mark.parametrize("is_ros_1", [False, True])
def test_packed_images_have_topics_of_their_own(is_ros_1: bool, tmp_path: Path) -> None:  # noqa: FBT001 - a case
    body = """
        #include <image_transport/image_transport.hpp>
        int main(int argc, char** argv) {
          auto node = std::make_shared<rclcpp::Node>("view");
          image_transport::create_subscription(node.get(), "left", take, "compressed", rmw_qos_profile_sensor_data);
          image_transport::create_subscription(node.get(), "right", take, "raw");
        }
    """
    ros_1 = """
        #include <image_transport/image_transport.h>
        int main(int argc, char** argv) {
          ros::init(argc, argv, "view");
          ros::NodeHandle nh;
          image_transport::ImageTransport it(nh);
          it.subscribe("left", 1, take, image_transport::TransportHints("compressed"));
          it.subscribe("right", 1, take);
        }
    """
    made, _ = walk(tmp_path, {"main.cpp": ros_1 if is_ros_1 else body}, is_ros_1=is_ros_1)
    assert tell(made)[1:] == [
        "subscribes topic left/compressed sensor_msgs/msg/CompressedImage",
        "subscribes topic right sensor_msgs/msg/Image",
    ]
