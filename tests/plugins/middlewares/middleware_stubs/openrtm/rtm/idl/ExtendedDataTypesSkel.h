#pragma once
#include <rtm/idl/BasicDataTypeSkel.h>
namespace RTC {
struct Pose2D { double x, y, heading; };
struct TimedPose2D { Time tm; Pose2D data; };
}
