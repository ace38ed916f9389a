// A stand-in for rclcpp_action: see README.md.
#ifndef RCLCPP_ACTION__RCLCPP_ACTION_HPP_
#define RCLCPP_ACTION__RCLCPP_ACTION_HPP_

#include <array>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <string>

#include "rclcpp/rclcpp.hpp"

struct rcl_action_server_options_t
{
};

inline rcl_action_server_options_t rcl_action_server_get_default_options()
{
  return {};
}

namespace rclcpp_action
{

using GoalUUID = std::array<std::uint8_t, 16>;

enum class GoalResponse { REJECT, ACCEPT_AND_EXECUTE, ACCEPT_AND_DEFER };
enum class CancelResponse { REJECT, ACCEPT };

template<typename Action>
class ServerGoalHandle
{
public:
  bool is_active() const;
  bool is_canceling() const;
  bool is_executing() const;
  void succeed(std::shared_ptr<typename Action::Result> result);
  void canceled(std::shared_ptr<typename Action::Result> result);
  void publish_feedback(std::shared_ptr<typename Action::Feedback> feedback);
  void abort(std::shared_ptr<typename Action::Result> result);
};

template<typename Action>
class ClientGoalHandle
{
public:
  using SharedPtr = std::shared_ptr<ClientGoalHandle<Action>>;
};

template<typename Action>
class Server
{
public:
  using SharedPtr = std::shared_ptr<Server<Action>>;
};

template<typename Action>
class Client
{
public:
  using SharedPtr = std::shared_ptr<Client<Action>>;
  struct SendGoalOptions
  {
  };
  std::shared_future<typename ClientGoalHandle<Action>::SharedPtr> async_send_goal(
    const typename Action::Goal & goal, const SendGoalOptions & options = SendGoalOptions());
  bool wait_for_action_server(std::chrono::nanoseconds timeout);
};

template<typename Action, typename AnyNode>
typename Server<Action>::SharedPtr create_server(
  AnyNode, const std::string &,
  std::function<GoalResponse(const GoalUUID &, std::shared_ptr<const typename Action::Goal>)>,
  std::function<CancelResponse(std::shared_ptr<ServerGoalHandle<Action>>)>,
  std::function<void(std::shared_ptr<ServerGoalHandle<Action>>)>,
  const rcl_action_server_options_t & = rcl_action_server_get_default_options(),
  rclcpp::CallbackGroup::SharedPtr = nullptr)
{
  return nullptr;
}

template<typename Action, typename AnyNode>
typename Client<Action>::SharedPtr create_client(
  AnyNode, const std::string &, rclcpp::CallbackGroup::SharedPtr = nullptr)
{
  return nullptr;
}

}  // namespace rclcpp_action

#endif  // RCLCPP_ACTION__RCLCPP_ACTION_HPP_
