// Made by archgen from user.

#include "rt_g/user_node.hpp"

#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <utility>

#include "rt_g/user_behaviour.hpp"
#include "rclcpp_components/register_node_macro.hpp"

namespace people
{

Asker::Asker(const rclcpp::NodeOptions & options)
: rclcpp::Node("user", options)
{
  answers_group_ = create_callback_group(rclcpp::CallbackGroupType::Reentrant);
  create_interfaces();
  behaviour_ = std::make_unique<AskerBehaviour>(*this);
}

Asker::~Asker() = default;

void Asker::create_interfaces()
{
  // g.user.plan
  plan_service_client_ = create_client<std_srvs::srv::Trigger>(
    "plan");
  plan_waiting_client_ = create_client<std_srvs::srv::Trigger>(
    "plan",
    rclcpp::ServicesQoS(),
    answers_group_);
  // g.user.go
  go_action_client_ = rclcpp_action::create_client<test_msgs::action::Fibonacci>(
    this,
    "go");
}

void Asker::call_plan(
  std_srvs::srv::Trigger::Request::SharedPtr request,
  std::function<void(std_srvs::srv::Trigger::Response::SharedPtr)> callback)
{
  plan_service_client_->async_send_request(
    std::move(request),
    [callback](rclcpp::Client<std_srvs::srv::Trigger>::SharedFuture future) {
      callback(future.get());
    });
}

std::shared_future<std_srvs::srv::Trigger::Response::SharedPtr>
Asker::call_plan(std_srvs::srv::Trigger::Request::SharedPtr request)
{
  return plan_waiting_client_->async_send_request(std::move(request)).future.share();
}

bool Asker::wait_for_plan(std::chrono::nanoseconds timeout)
{
  return plan_service_client_->wait_for_service(timeout);
}

std::shared_future<rclcpp_action::ClientGoalHandle<test_msgs::action::Fibonacci>::SharedPtr>
Asker::send_go(
  const test_msgs::action::Fibonacci::Goal & goal,
  const rclcpp_action::Client<test_msgs::action::Fibonacci>::SendGoalOptions & options)
{
  return go_action_client_->async_send_goal(goal, options);
}

bool Asker::wait_for_go(std::chrono::nanoseconds timeout)
{
  return go_action_client_->wait_for_action_server(timeout);
}

}  // namespace people

RCLCPP_COMPONENTS_REGISTER_NODE(people::Asker)
