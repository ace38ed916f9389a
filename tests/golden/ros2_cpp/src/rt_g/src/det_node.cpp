// Made by archgen from archgen.yaml:40:3.

#include "rt_g/det_node.hpp"

#include <chrono>
#include <exception>
#include <future>
#include <memory>
#include <utility>

#include "rt_g/det_behaviour.hpp"

namespace rt_g
{

Det::Det(const rclcpp::NodeOptions & options)
: rclcpp_lifecycle::LifecycleNode("det", "/perception", options)
{
  reentrant_group_ = create_callback_group(rclcpp::CallbackGroupType::Reentrant);
}

Det::~Det() = default;

void Det::create_interfaces()
{
  rclcpp::SubscriptionOptions reentrant_options;
  reentrant_options.callback_group = reentrant_group_;
  // g.det.found
  found_publisher_ = create_publisher<std_msgs::msg::String>(
    "detections",
    rclcpp::QoS(rclcpp::KeepLast(3))
    .reliable()
    .durability_volatile()
    .deadline(rclcpp::Duration::from_nanoseconds(100000000))
    .lifespan(rclcpp::Duration::from_nanoseconds(1000000000))
    .liveliness(rclcpp::LivelinessPolicy::ManualByTopic)
    .liveliness_lease_duration(rclcpp::Duration::from_nanoseconds(2000000000)));
  // g.det.image
  image_subscription_ = create_subscription<sensor_msgs::msg::Image>(
    "/camera/image",
    rclcpp::QoS(rclcpp::KeepLast(10))
    .reliable()
    .durability_volatile(),
    [this](sensor_msgs::msg::Image::ConstSharedPtr message) {
      behaviour_->receive_image(std::move(message));
    },
    reentrant_options);
  // g.det.cloud
  cloud_subscription_ = create_subscription<sensor_msgs::msg::PointCloud2>(
    "/g/cam/cloud",
    rclcpp::QoS(rclcpp::KeepLast(10))
    .reliable()
    .durability_volatile(),
    [this](sensor_msgs::msg::PointCloud2::ConstSharedPtr message) {
      behaviour_->receive_cloud(std::move(message));
    },
    reentrant_options);
  // g.det.plan
  plan_service_ = create_service<std_srvs::srv::Trigger>(
    "/g/det/plan",
    [this](
      const std_srvs::srv::Trigger::Request::SharedPtr request,
      const std_srvs::srv::Trigger::Response::SharedPtr response) {
      behaviour_->serve_plan(*request, *response);
    },
    rclcpp::ServicesQoS(),
    reentrant_group_);
  // g.det.go
  go_action_server_ = rclcpp_action::create_server<test_msgs::action::Fibonacci>(
    this,
    "/g/det/go",
    [](const rclcpp_action::GoalUUID &, const auto & /*goal*/) {
      return rclcpp_action::GoalResponse::ACCEPT_AND_EXECUTE;
    },
    [](const auto & /*goal*/) {
      return rclcpp_action::CancelResponse::ACCEPT;
    },
    [this](const auto & goal) {
      accept_go(goal);
    },
    rcl_action_server_get_default_options(),
    reentrant_group_);
}

void Det::publish_found(const std_msgs::msg::String & message)
{
  found_publisher_->publish(message);
}

void Det::publish_found(std_msgs::msg::String::UniquePtr message)
{
  found_publisher_->publish(std::move(message));
}

void Det::accept_go(
  std::shared_ptr<rclcpp_action::ServerGoalHandle<test_msgs::action::Fibonacci>> goal)
{
  go_goals_.remove_if(
    [](const std::future<void> & each) {
      return each.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    });
  // A thread of its own carries it out: the node goes on meanwhile.
  go_goals_.push_back(
    std::async(
      std::launch::async,
      [this, goal]() {
        try {
          behaviour_->execute_go(goal);
        } catch (const std::exception & error) {
          RCLCPP_ERROR(get_logger(), "the goal of go failed: %s", error.what());
          if (goal->is_active()) {
            goal->abort(std::make_shared<test_msgs::action::Fibonacci::Result>());
          }
        }
      }));
}

Det::CallbackReturn Det::on_configure(const rclcpp_lifecycle::State & state)
{
  create_interfaces();
  behaviour_ = std::make_unique<DetBehaviour>(*this);
  return LifecycleNode::on_configure(state);
}

Det::CallbackReturn Det::on_cleanup(const rclcpp_lifecycle::State & state)
{
  destroy_interfaces();
  return LifecycleNode::on_cleanup(state);
}

Det::CallbackReturn Det::on_shutdown(const rclcpp_lifecycle::State & state)
{
  destroy_interfaces();
  return LifecycleNode::on_shutdown(state);
}

void Det::destroy_interfaces()
{
  image_subscription_.reset();
  cloud_subscription_.reset();
  plan_service_.reset();
  go_action_server_.reset();
  go_goals_.clear();
  behaviour_.reset();
  found_publisher_.reset();
}

}  // namespace rt_g
