// Made by archgen from det.

#include "rt_g/det_node.hpp"

#include <chrono>
#include <exception>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <type_traits>
#include <utility>

#include "rt_g/det_behaviour.hpp"

namespace rt_g
{

namespace
{

/// Call a hook of the own class where it has it. One that returns false fails.
template<typename Own, typename Hook>
bool run_hook([[maybe_unused]] Own * own, [[maybe_unused]] Hook hook)
{
  if constexpr (std::is_invocable_r_v<bool, Hook, Own &>) {
    return !own || hook(*own);
  } else if constexpr (std::is_invocable_v<Hook, Own &>) {
    if (own) {
      hook(*own);
    }
  }
  return true;
}

/// Say a refusal in a response that has a message.
template<typename Response>
auto say(Response & response, const std::string & text, int) -> decltype(response.message = text)
{
  return response.message = text;
}

template<typename Response>
void say(Response &, const std::string &, ...)
{
}

}  // namespace

Det::Det(const rclcpp::NodeOptions & options)
: rclcpp_lifecycle::LifecycleNode("det", options)
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
  // g.det.cloud
  cloud_subscription_ = create_subscription<sensor_msgs::msg::PointCloud2>(
    "cloud",
    rclcpp::QoS(rclcpp::KeepLast(10))
    .reliable()
    .durability_volatile(),
    [this](sensor_msgs::msg::PointCloud2::ConstSharedPtr message) {
      if (is_hearing_) {
        behaviour_->receive_cloud(std::move(message));
      }
    },
    reentrant_options);
  // g.det.image
  image_subscription_ = create_subscription<sensor_msgs::msg::Image>(
    "image",
    rclcpp::QoS(rclcpp::KeepLast(10))
    .reliable()
    .durability_volatile(),
    [this](sensor_msgs::msg::Image::ConstSharedPtr message) {
      if (is_hearing_) {
        behaviour_->receive_image(std::move(message));
      }
    },
    reentrant_options);
  // g.det.plan
  plan_service_ = create_service<std_srvs::srv::Trigger>(
    "plan",
    [this](
      const std_srvs::srv::Trigger::Request::SharedPtr request,
      const std_srvs::srv::Trigger::Response::SharedPtr response) {
      if (!is_hearing_) {
        say(*response, refuse("plan"), 0);
        return;
      }
      behaviour_->serve_plan(*request, *response);
    },
    rclcpp::ServicesQoS(),
    reentrant_group_);
  // g.det.go
  go_action_server_ = rclcpp_action::create_server<test_msgs::action::Fibonacci>(
    this,
    "go",
    [this](const rclcpp_action::GoalUUID &, const auto & /*goal*/) {
      if (!is_hearing_) {
        refuse("go");
        return rclcpp_action::GoalResponse::REJECT;
      }
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
  const std::lock_guard<std::mutex> lock(mutex_);
  go_handles_.remove_if([](const auto & each) {return each.expired();});
  go_handles_.push_back(goal);
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

std::string Det::refuse(const std::string & port) const
{
  const std::string text = port + " is refused: " + get_name() + " is not active";
  RCLCPP_WARN(get_logger(), "%s", text.c_str());
  return text;
}

Det::CallbackReturn Det::on_configure(const rclcpp_lifecycle::State & state)
{
  create_interfaces();
  behaviour_ = std::make_unique<DetBehaviour>(*this);
  LifecycleNode::on_configure(state);
  if (!run_hook(
      behaviour_.get(),
      [](auto & own) -> decltype(own.on_configure()) {return own.on_configure();}))
  {
    destroy_interfaces();
    return CallbackReturn::FAILURE;
  }
  return CallbackReturn::SUCCESS;
}

Det::CallbackReturn Det::on_activate(const rclcpp_lifecycle::State & state)
{
  LifecycleNode::on_activate(state);
  is_sending_ = true;
  if (!run_hook(
      behaviour_.get(),
      [](auto & own) -> decltype(own.on_activate()) {return own.on_activate();}))
  {
    silence(state);
    return CallbackReturn::FAILURE;
  }
  is_hearing_ = true;
  return CallbackReturn::SUCCESS;
}

Det::CallbackReturn Det::on_deactivate(const rclcpp_lifecycle::State & state)
{
  is_hearing_ = false;
  run_hook(
    behaviour_.get(),
    [](auto & own) -> decltype(own.on_deactivate()) {return own.on_deactivate();});
  silence(state);
  return CallbackReturn::SUCCESS;
}

void Det::silence(const rclcpp_lifecycle::State & state)
{
  is_hearing_ = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const auto & each : go_handles_) {
      const auto goal = each.lock();
      try {
        if (goal && goal->is_active()) {
          goal->abort(std::make_shared<test_msgs::action::Fibonacci::Result>());
        }
      } catch (const std::exception & error) {
        // Its own thread was quicker.
        RCLCPP_DEBUG(get_logger(), "%s", error.what());
      }
    }
  }
  is_sending_ = false;
  LifecycleNode::on_deactivate(state);
}

Det::CallbackReturn Det::on_cleanup(const rclcpp_lifecycle::State & state)
{
  run_hook(
    behaviour_.get(),
    [](auto & own) -> decltype(own.on_cleanup()) {return own.on_cleanup();});
  destroy_interfaces();
  return LifecycleNode::on_cleanup(state);
}

Det::CallbackReturn Det::on_shutdown(const rclcpp_lifecycle::State & state)
{
  if (is_sending_) {
    on_deactivate(state);
  }
  run_hook(
    behaviour_.get(),
    [](auto & own) -> decltype(own.on_shutdown()) {return own.on_shutdown();});
  destroy_interfaces();
  return CallbackReturn::SUCCESS;
}

Det::CallbackReturn Det::on_error(const rclcpp_lifecycle::State & state)
{
  if (is_sending_) {
    on_deactivate(state);
  }
  run_hook(
    behaviour_.get(),
    [](auto & own) -> decltype(own.on_error()) {return own.on_error();});
  destroy_interfaces();
  return CallbackReturn::SUCCESS;
}

void Det::destroy_interfaces()
{
  cloud_subscription_.reset();
  image_subscription_.reset();
  plan_service_.reset();
  go_action_server_.reset();
  go_goals_.clear();
  behaviour_.reset();
  found_publisher_.reset();
}

}  // namespace rt_g
