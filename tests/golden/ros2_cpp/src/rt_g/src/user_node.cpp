// Made by archgen from archgen.yaml:38:3.

#include "rt_g/user_node.hpp"

#include <functional>
#include <future>
#include <memory>
#include <utility>

#include "rt_g/user_behaviour.hpp"

namespace people
{

Asker::Asker(const rclcpp::NodeOptions & options)
: rclcpp::Node("user", options)
{
  create_interfaces();
  behaviour_ = std::make_unique<AskerBehaviour>(*this);
}

Asker::~Asker() = default;

void Asker::create_interfaces()
{
  // g.user.plan
  plan_service_client_ = create_client<std_srvs::srv::Trigger>(
    "/g/det/plan");
  // g.user.go
  go_action_client_ = rclcpp_action::create_client<test_msgs::action::Fibonacci>(
    this,
    "/g/det/go");
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

std::shared_future<rclcpp_action::ClientGoalHandle<test_msgs::action::Fibonacci>::SharedPtr>
Asker::send_go(
  const test_msgs::action::Fibonacci::Goal & goal,
  const rclcpp_action::Client<test_msgs::action::Fibonacci>::SendGoalOptions & options)
{
  return go_action_client_->async_send_goal(goal, options);
}

}  // namespace people
