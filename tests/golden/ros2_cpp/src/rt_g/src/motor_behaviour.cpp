// What Motor does: written once by archgen, and yours since.

#include "rt_g/motor_behaviour.hpp"

#include "rt_g/motor_node.hpp"

namespace rt_g
{

MotorBehaviour::MotorBehaviour(Motor & node)
: node_(node)
{
  RCLCPP_DEBUG(node_.get_logger(), "ready");
}

void MotorBehaviour::receive_target(
  std_msgs::msg::String::ConstSharedPtr /*message*/)
{
}

}  // namespace rt_g
