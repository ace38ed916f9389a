// Made by archgen from user.
// What the node does stands in user_behaviour.cpp.

#ifndef RT_G__USER_NODE_HPP_
#define RT_G__USER_NODE_HPP_

#include <chrono>
#include <functional>
#include <future>
#include <memory>

#include "rclcpp/rclcpp.hpp"
#include "rclcpp_action/rclcpp_action.hpp"
#include "std_srvs/srv/trigger.hpp"
#include "test_msgs/action/fibonacci.hpp"

namespace people
{

class AskerBehaviour;

/// User.
class Asker : public rclcpp::Node
{
public:
  /// Declare the parameters, and create what the node uses.
  explicit Asker(const rclcpp::NodeOptions & options = rclcpp::NodeOptions());

  ~Asker() override;

  /// Send a request of g.user.plan.
  /// The callback gets the response.
  void call_plan(
    std_srvs::srv::Trigger::Request::SharedPtr request,
    std::function<void(std_srvs::srv::Trigger::Response::SharedPtr)> callback);

  /// Send a request of g.user.plan.
  /// Return the future of its response. Wait for it where another thread takes it:
  /// in the thread of a goal, or with `threads` of more than one.
  std::shared_future<std_srvs::srv::Trigger::Response::SharedPtr>
  call_plan(std_srvs::srv::Trigger::Request::SharedPtr request);

  /// Return whether its server is there, after waiting so long for it at most.
  bool wait_for_plan(std::chrono::nanoseconds timeout);

  /// Send a goal of g.user.go.
  /// Return the future of its handle.
  std::shared_future<rclcpp_action::ClientGoalHandle<test_msgs::action::Fibonacci>::SharedPtr>
  send_go(
    const test_msgs::action::Fibonacci::Goal & goal,
    const rclcpp_action::Client<test_msgs::action::Fibonacci>::SendGoalOptions & options =
    rclcpp_action::Client<test_msgs::action::Fibonacci>::SendGoalOptions());

  /// Return whether its server is there, after waiting so long for it at most.
  bool wait_for_go(std::chrono::nanoseconds timeout);

private:
  void create_interfaces();

  rclcpp::CallbackGroup::SharedPtr answers_group_;
  rclcpp::Client<std_srvs::srv::Trigger>::SharedPtr plan_service_client_;
  rclcpp::Client<std_srvs::srv::Trigger>::SharedPtr plan_waiting_client_;
  rclcpp_action::Client<test_msgs::action::Fibonacci>::SharedPtr go_action_client_;
  std::unique_ptr<AskerBehaviour> behaviour_;
};

}  // namespace people

#endif  // RT_G__USER_NODE_HPP_
