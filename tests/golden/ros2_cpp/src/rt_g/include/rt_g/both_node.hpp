// Made by archgen from both.
// What the node does stands in both_behaviour.cpp.

#ifndef RT_G__BOTH_NODE_HPP_
#define RT_G__BOTH_NODE_HPP_

#include <chrono>
#include <functional>
#include <future>
#include <memory>

#include "rclcpp/rclcpp.hpp"
#include "sensor_msgs/msg/image.hpp"
#include "std_srvs/srv/trigger.hpp"

namespace rt_g
{

class BothBehaviour;

/// Both.
class Both : public rclcpp::Node
{
public:
  /// Declare the parameters, and create what the node uses.
  explicit Both(const rclcpp::NodeOptions & options = rclcpp::NodeOptions());

  ~Both() override;

  /// Send a request of g.fast.plan.
  /// The callback gets the response.
  void call_plan(
    std_srvs::srv::Trigger::Request::SharedPtr request,
    std::function<void(std_srvs::srv::Trigger::Response::SharedPtr)> callback);

  /// Send a request of g.fast.plan.
  /// Return the future of its response. Wait for it where another thread takes it:
  /// in the thread of a goal, or with `threads` of more than one.
  std::shared_future<std_srvs::srv::Trigger::Response::SharedPtr>
  call_plan(std_srvs::srv::Trigger::Request::SharedPtr request);

  /// Return whether its server is there, after waiting so long for it at most.
  bool wait_for_plan(std::chrono::nanoseconds timeout);

private:
  void create_interfaces();

  rclcpp::CallbackGroup::SharedPtr quick_group_;
  rclcpp::CallbackGroup::SharedPtr answers_group_;
  rclcpp::Client<std_srvs::srv::Trigger>::SharedPtr plan_service_client_;
  rclcpp::Client<std_srvs::srv::Trigger>::SharedPtr plan_waiting_client_;
  std::unique_ptr<BothBehaviour> behaviour_;
  rclcpp::Subscription<sensor_msgs::msg::Image>::SharedPtr image_subscription_;
  rclcpp::TimerBase::SharedPtr fast_timer_;
  rclcpp::TimerBase::SharedPtr slow_timer_;
};

}  // namespace rt_g

#endif  // RT_G__BOTH_NODE_HPP_
