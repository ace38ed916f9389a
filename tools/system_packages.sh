#!/bin/sh
# Install what archgen (run) or all of its tests (test-all) need of the system, or ROS 1 for the tests that run nodes on it (ros).
# Does nothing where it is there already; where it may not install, it says what to install and, for the tests, stops.
set -eu
what=${1:-run}
missing=""
wanted=""
need_library() { ldconfig -p 2>/dev/null | grep -q "$1" || missing="$missing $2"; }
need_command() { command -v "$1" >/dev/null 2>&1 || missing="$missing $2"; }

if command -v ldconfig >/dev/null 2>&1; then
    need_library libgobject-2.0.so.0 libglib2.0-0
    need_library libX11.so.6 libx11-6
    need_library libXext.so.6 libxext6
    need_library libXrender.so.1 libxrender1
    need_library libexpat.so.1 libexpat1
fi
${PYTHON:-python3} -c "import ensurepip, venv" 2>/dev/null || missing="$missing python3-venv"
need_command git git
if [ "$what" = test-all ]; then
    # Playwright's own Node; ldd names it as the one library that nothing else here brings.
    if command -v ldconfig >/dev/null 2>&1; then need_library libatomic.so.1 libatomic1; fi
    need_command chromium chromium
    command -v firefox >/dev/null 2>&1 || need_command firefox-esr firefox-esr
    need_command soffice libreoffice-writer-nogui
    need_command pdftoppm poppler-utils
    fc-list 2>/dev/null | grep -q Carlito || missing="$missing fontconfig fonts-crosextra-carlito"
    need_command java default-jre-headless
    need_command javac default-jdk-headless
    need_command npm npm
    need_command plantuml plantuml
    need_command shellcheck shellcheck
    need_command systemd-analyze systemd
    [ -e /usr/share/i18n/locales/tr_TR ] || missing="$missing locales"
    need_command g++ g++
    need_command luac5.1 lua5.1
    need_command uncrustify uncrustify
    need_command cpplint cpplint
    /usr/bin/python3 -c "import rosidl_adapter" 2>/dev/null || missing="$missing python3-rosidl"
    /usr/bin/python3 -c "import genmsg" 2>/dev/null || missing="$missing python3-genmsg"
fi
if [ "$what" = ros ]; then
    if ! command -v apt-cache >/dev/null 2>&1; then
        echo "archgen: there is no ROS 1 for this system; its tests are skipped" >&2
        exit 0
    fi
    need_command roslaunch python3-roslaunch
    need_command rosmaster python3-rosmaster
    need_command rostest python3-rostest
    need_command catkin_make catkin
    ls /usr/lib/*/cmake/rostest >/dev/null 2>&1 || missing="$missing librostest-dev"
    [ -x /usr/lib/rosout/rosout ] || missing="$missing rosout"
    [ -e /usr/share/message_generation ] || missing="$missing ros-message-generation"
    [ -e /usr/share/message_runtime ] || missing="$missing ros-message-runtime"
    /usr/bin/python3 -c "import rospy" 2>/dev/null || missing="$missing python3-rospy"
    /usr/bin/python3 -c "import rosservice" 2>/dev/null || missing="$missing python3-rosservice"
    /usr/bin/python3 -c "import actionlib" 2>/dev/null || missing="$missing python3-actionlib"
    for package in std actionlib geometry sensor nav tf2; do
        /usr/bin/python3 -c "import ${package}_msgs" 2>/dev/null || missing="$missing python3-$package-msgs"
        [ -e "/usr/share/${package}_msgs/msg" ] || missing="$missing ros-$package-msgs"
    done
    /usr/bin/python3 -c "import std_srvs" 2>/dev/null || missing="$missing python3-std-srvs"
    for package in std actionlib geometry; do
        [ -e "/usr/share/${package}_msgs/cmake" ] || missing="$missing lib$package-msgs-dev"
    done
fi
# The browser without its windows: tests take the whole one where a system has no package of it, which costs more time.
is_offered() { command -v apt-cache >/dev/null 2>&1 && [ -n "$(apt-cache madison "$1" 2>/dev/null)" ]; }
if [ "$what" = test-all ] && ! command -v chromium-headless-shell >/dev/null 2>&1; then wanted=chromium-headless-shell; fi
if [ -z "$missing" ] && { [ -z "$wanted" ] || ! is_offered "$wanted"; }; then exit 0; fi
if command -v apt-get >/dev/null 2>&1 && [ "$(id -u)" = 0 ]; then
    sudo=""
elif command -v apt-get >/dev/null 2>&1 && command -v sudo >/dev/null 2>&1 && sudo -n true 2>/dev/null; then
    sudo=sudo
elif [ -z "$missing" ]; then
    exit 0
else
    echo "archgen: please install these packages (Debian's names):$missing" >&2
    # Without the drawing libraries archgen still makes everything but the pictures, and without ROS 1 its tests are skipped.
    [ "$what" = test-all ] || exit 0
    exit 1
fi
echo "installing$missing${wanted:+ $wanted}"
$sudo apt-get update -qq || [ -z "$missing" ]
if [ "$what" = ros ] && ! apt-cache show python3-roslaunch >/dev/null 2>&1; then
    echo "archgen: this system's packages have no ROS 1; its tests are skipped" >&2
    exit 0
fi
# shellcheck disable=SC2086 # a list of packages
[ -z "$missing" ] || DEBIAN_FRONTEND=noninteractive $sudo apt-get install -y -qq --no-install-recommends $missing >/dev/null
if [ -n "$wanted" ] && is_offered "$wanted"; then
    DEBIAN_FRONTEND=noninteractive $sudo apt-get install -y -qq --no-install-recommends "$wanted" >/dev/null || true
fi
