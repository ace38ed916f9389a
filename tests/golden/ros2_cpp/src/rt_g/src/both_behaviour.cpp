// What Both does: written once by archgen, and yours since.

#include "rt_g/both_behaviour.hpp"

#include "rt_g/both_node.hpp"

namespace rt_g
{

BothBehaviour::BothBehaviour(Both & node)
: node_(node)
{
  RCLCPP_DEBUG(node_.get_logger(), "ready");
}

void BothBehaviour::receive_image(
  sensor_msgs::msg::Image::ConstSharedPtr /*message*/)
{
}

void BothBehaviour::on_timer_fast()
{
}

void BothBehaviour::on_timer_slow()
{
}

}  // namespace rt_g
