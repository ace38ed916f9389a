// What Det does: written once by archgen, and yours since.

#include "rt_g/det_behaviour.hpp"

#include <memory>

#include "rt_g/det_node.hpp"

namespace rt_g
{

DetBehaviour::DetBehaviour(Det & node)
: node_(node)
{
  RCLCPP_DEBUG(node_.get_logger(), "ready");
}

bool DetBehaviour::on_activate()
{
  return true;
}

void DetBehaviour::on_deactivate()
{
}

void DetBehaviour::receive_cloud(
  sensor_msgs::msg::PointCloud2::ConstSharedPtr /*message*/)
{
}

void DetBehaviour::receive_image(
  sensor_msgs::msg::Image::ConstSharedPtr /*message*/)
{
}

void DetBehaviour::serve_plan(
  const std_srvs::srv::Trigger::Request & /*request*/,
  std_srvs::srv::Trigger::Response & /*response*/)
{
  RCLCPP_WARN_ONCE(
    node_.get_logger(), "serve_plan is not written yet: its answers say nothing");
}

void DetBehaviour::execute_go(
  std::shared_ptr<rclcpp_action::ServerGoalHandle<test_msgs::action::Fibonacci>> goal)
{
  RCLCPP_WARN_THROTTLE(
    node_.get_logger(), *node_.get_clock(), 5000,
    "execute_go is not written yet: its goals are aborted");
  goal->abort(std::make_shared<test_msgs::action::Fibonacci::Result>());
}

}  // namespace rt_g
