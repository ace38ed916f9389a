// Made by archgen from both.

#include "rt_g/both_node.hpp"

#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <utility>

#include "rt_g/both_behaviour.hpp"

namespace rt_g
{

Both::Both(const rclcpp::NodeOptions & options)
: rclcpp::Node("both", options)
{
  quick_group_ = create_callback_group(rclcpp::CallbackGroupType::MutuallyExclusive);
  answers_group_ = create_callback_group(rclcpp::CallbackGroupType::Reentrant);
  create_interfaces();
  behaviour_ = std::make_unique<BothBehaviour>(*this);
}

Both::~Both() = default;

void Both::create_interfaces()
{
  // g.slow.image
  image_subscription_ = create_subscription<sensor_msgs::msg::Image>(
    "image",
    rclcpp::QoS(rclcpp::KeepLast(10))
    .reliable()
    .durability_volatile(),
    [this](sensor_msgs::msg::Image::ConstSharedPtr message) {
      behaviour_->receive_image(std::move(message));
    });
  // g.fast.plan
  plan_service_client_ = create_client<std_srvs::srv::Trigger>(
    "plan",
    rclcpp::ServicesQoS(),
    quick_group_);
  plan_waiting_client_ = create_client<std_srvs::srv::Trigger>(
    "plan",
    rclcpp::ServicesQoS(),
    answers_group_);
  // g.fast
  fast_timer_ = rclcpp::create_timer(
    this,
    get_clock(),
    rclcpp::Duration::from_nanoseconds(20000000),
    [this]() {behaviour_->on_timer_fast();},
    quick_group_);
  // g.slow
  slow_timer_ = rclcpp::create_timer(
    this,
    get_clock(),
    rclcpp::Duration::from_nanoseconds(500000000),
    [this]() {behaviour_->on_timer_slow();});
}

void Both::call_plan(
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
Both::call_plan(std_srvs::srv::Trigger::Request::SharedPtr request)
{
  return plan_waiting_client_->async_send_request(std::move(request)).future.share();
}

bool Both::wait_for_plan(std::chrono::nanoseconds timeout)
{
  return plan_service_client_->wait_for_service(timeout);
}

}  // namespace rt_g
