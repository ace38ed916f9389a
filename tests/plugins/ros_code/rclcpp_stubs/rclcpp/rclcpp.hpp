// A stand-in for rclcpp: see README.md.
#ifndef RCLCPP__RCLCPP_HPP_
#define RCLCPP__RCLCPP_HPP_

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "rcl_interfaces/msg/parameter_descriptor.hpp"
#include "rcl_interfaces/msg/set_parameters_result.hpp"

#define RCLCPP_DEBUG(logger, ...) rclcpp::take_words(logger, __VA_ARGS__)
#define RCLCPP_WARN(logger, ...) rclcpp::take_words(logger, __VA_ARGS__)
#define RCLCPP_WARN_THROTTLE(logger, clock, milliseconds, ...) \
  rclcpp::take_words((static_cast<void>((clock).now() + milliseconds), logger), __VA_ARGS__)
#define RCLCPP_WARN_ONCE(logger, ...) rclcpp::take_words(logger, __VA_ARGS__)
#define RCLCPP_INFO(logger, ...) rclcpp::take_words(logger, __VA_ARGS__)
#define RCLCPP_ERROR(logger, ...) rclcpp::take_words(logger, __VA_ARGS__)

namespace rclcpp
{

class Logger
{
};

template<typename... Words>
void take_words(const Logger &, const char *, const Words &...)
{
}

void init(int argc, char const * const * argv);
bool shutdown();
bool ok();

class Duration
{
public:
  static Duration from_nanoseconds(std::int64_t nanoseconds);
};

/// It becomes the message, whose header not each node includes.
class Time
{
public:
  template<typename Message>
  operator Message() const;
};

int operator+(const Time & time, int milliseconds);

class Clock
{
public:
  using SharedPtr = std::shared_ptr<Clock>;
  Time now();
};

enum class LivelinessPolicy { Automatic, ManualByTopic };

struct KeepAll
{
};

struct KeepLast
{
  explicit KeepLast(std::size_t depth);
};

class QoS
{
public:
  explicit QoS(const KeepAll &);
  explicit QoS(const KeepLast &);
  QoS & reliable();
  QoS & best_effort();
  QoS & durability_volatile();
  QoS & transient_local();
  QoS & deadline(const Duration &);
  QoS & lifespan(const Duration &);
  QoS & liveliness(LivelinessPolicy);
  QoS & liveliness_lease_duration(const Duration &);

protected:
  QoS();
};

class ServicesQoS : public QoS
{
public:
  ServicesQoS();
};

enum class CallbackGroupType { MutuallyExclusive, Reentrant };

class CallbackGroup
{
public:
  using SharedPtr = std::shared_ptr<CallbackGroup>;
};

struct SubscriptionOptions
{
  CallbackGroup::SharedPtr callback_group;
};

enum class ParameterType
{
  PARAMETER_NOT_SET,
  PARAMETER_BOOL,
  PARAMETER_INTEGER,
  PARAMETER_DOUBLE,
  PARAMETER_STRING,
  PARAMETER_BOOL_ARRAY,
  PARAMETER_INTEGER_ARRAY,
  PARAMETER_DOUBLE_ARRAY,
  PARAMETER_STRING_ARRAY
};

class ParameterValue
{
public:
  explicit ParameterValue(bool value);
  explicit ParameterValue(std::int64_t value);
  explicit ParameterValue(double value);
  explicit ParameterValue(const std::string & value);
  explicit ParameterValue(const std::vector<bool> & value);
  explicit ParameterValue(const std::vector<std::int64_t> & value);
  explicit ParameterValue(const std::vector<double> & value);
  explicit ParameterValue(const std::vector<std::string> & value);
};

class Parameter
{
public:
  const std::string & get_name() const;
  ParameterType get_type() const;
  bool as_bool() const;
  std::int64_t as_int() const;
  double as_double() const;
  const std::string & as_string() const;
  const std::vector<bool> & as_bool_array() const;
  const std::vector<std::int64_t> & as_integer_array() const;
  const std::vector<double> & as_double_array() const;
  const std::vector<std::string> & as_string_array() const;
  template<typename Value>
  Value get_value() const;
};

class NodeOptions
{
public:
  template<typename Value>
  NodeOptions & append_parameter_override(const std::string &, const Value & value)
  {
    static_cast<void>(ParameterValue(value));
    return *this;
  }
};

namespace node_interfaces
{

class NodeBaseInterface
{
public:
  using SharedPtr = std::shared_ptr<NodeBaseInterface>;
};

class NodeTopicsInterface
{
public:
  using SharedPtr = std::shared_ptr<NodeTopicsInterface>;
  std::string resolve_topic_name(const std::string & name, bool only_expand = false) const;
};

class NodeServicesInterface
{
public:
  using SharedPtr = std::shared_ptr<NodeServicesInterface>;
  std::string resolve_service_name(const std::string & name, bool only_expand = false) const;
};

class NodeGraphInterface
{
public:
  using SharedPtr = std::shared_ptr<NodeGraphInterface>;
  using Names = std::map<std::string, std::vector<std::string>>;
  Names get_publisher_names_and_types_by_node(
    const std::string & node, const std::string & space, bool no_demangle = false) const;
  Names get_subscriber_names_and_types_by_node(
    const std::string & node, const std::string & space, bool no_demangle = false) const;
  Names get_service_names_and_types_by_node(
    const std::string & node, const std::string & space) const;
  Names get_client_names_and_types_by_node(
    const std::string & node, const std::string & space) const;
};

class NodeParametersInterface
{
public:
  using SharedPtr = std::shared_ptr<NodeParametersInterface>;
};

struct OnSetParametersCallbackHandle
{
  using SharedPtr = std::shared_ptr<OnSetParametersCallbackHandle>;
};

struct PostSetParametersCallbackHandle
{
  using SharedPtr = std::shared_ptr<PostSetParametersCallbackHandle>;
};

}  // namespace node_interfaces

template<typename Message>
class Publisher
{
public:
  using SharedPtr = std::shared_ptr<Publisher<Message>>;
  void publish(const Message & message);
  void publish(std::unique_ptr<Message> message);
};

struct GlobalIdentifier
{
  std::uint8_t data[16];
};

struct ReceivedMessage
{
  GlobalIdentifier publisher_gid;
};

class MessageInfo
{
public:
  const ReceivedMessage & get_rmw_message_info() const;
};

class TopicEndpointInfo
{
public:
  const std::string & node_name() const;
  const std::string & node_namespace() const;
  const std::array<std::uint8_t, 16> & endpoint_gid() const;
};

template<typename Message>
class Subscription
{
public:
  using SharedPtr = std::shared_ptr<Subscription<Message>>;
};

template<typename Type>
class Service
{
public:
  using SharedPtr = std::shared_ptr<Service<Type>>;
};

template<typename Type>
class Client
{
public:
  using SharedPtr = std::shared_ptr<Client<Type>>;
  using SharedFuture = std::shared_future<std::shared_ptr<typename Type::Response>>;
  struct FutureAndRequestId
  {
    std::future<std::shared_ptr<typename Type::Response>> future;
  };

  FutureAndRequestId async_send_request(std::shared_ptr<typename Type::Request>);
  bool wait_for_service(std::chrono::nanoseconds timeout);

  template<typename Callback>
  void async_send_request(std::shared_ptr<typename Type::Request>, Callback &&)
  {
    static_assert(std::is_invocable_v<Callback, SharedFuture>, "no callback for a response");
  }
};

class TimerBase
{
public:
  using SharedPtr = std::shared_ptr<TimerBase>;
  void cancel();
  void reset();
};

/// What nodes of either kind have.
class NodeParts
{
public:
  using OnSetParametersCallbackHandle = node_interfaces::OnSetParametersCallbackHandle;
  using PostSetParametersCallbackHandle = node_interfaces::PostSetParametersCallbackHandle;

  const char * get_name() const;
  const char * get_namespace() const;
  const char * get_fully_qualified_name() const;
  Logger get_logger() const;
  Clock::SharedPtr get_clock();
  CallbackGroup::SharedPtr create_callback_group(CallbackGroupType type, bool automatic = true);
  node_interfaces::NodeBaseInterface::SharedPtr get_node_base_interface();
  node_interfaces::NodeGraphInterface::SharedPtr get_node_graph_interface();
  node_interfaces::NodeTopicsInterface::SharedPtr get_node_topics_interface();
  node_interfaces::NodeServicesInterface::SharedPtr get_node_services_interface();
  node_interfaces::NodeParametersInterface::SharedPtr get_node_parameters_interface();

  bool has_parameter(const std::string & name) const;
  Parameter get_parameter(const std::string & name) const;
  const ParameterValue & declare_parameter(
    const std::string & name, const ParameterValue & value,
    const rcl_interfaces::msg::ParameterDescriptor & descriptor);
  const ParameterValue & declare_parameter(
    const std::string & name, ParameterType type,
    const rcl_interfaces::msg::ParameterDescriptor & descriptor);
  bool declare_parameter(const std::string & name, bool value);
  std::vector<std::string> declare_parameter(
    const std::string & name, const std::vector<std::string> & value);
  template<typename Value>
  bool get_parameter(const std::string & name, Value & value) const
  {
    value = get_parameter(name).template get_value<Value>();
    return true;
  }
  std::vector<TopicEndpointInfo> get_publishers_info_by_topic(
    const std::string & topic, bool no_mangle = false) const;
  PostSetParametersCallbackHandle::SharedPtr add_post_set_parameters_callback(
    std::function<void(const std::vector<Parameter> &)>);
  OnSetParametersCallbackHandle::SharedPtr add_on_set_parameters_callback(
    std::function<rcl_interfaces::msg::SetParametersResult(const std::vector<Parameter> &)>);

  template<typename Callback>
  TimerBase::SharedPtr create_wall_timer(
    std::chrono::nanoseconds, Callback &&, CallbackGroup::SharedPtr = nullptr)
  {
    static_assert(std::is_invocable_v<Callback>, "no callback for a timer");
    return nullptr;
  }

  template<typename Message, typename Callback>
  typename Subscription<Message>::SharedPtr create_subscription(
    const std::string &, const QoS &, Callback &&,
    const SubscriptionOptions & = SubscriptionOptions())
  {
    using Pointer = std::shared_ptr<const Message>;
    static_assert(
      std::is_invocable_v<Callback, Pointer> ||
      std::is_invocable_v<Callback, Pointer, const MessageInfo &>, "no callback for a message");
    return nullptr;
  }

  template<typename Type, typename Callback>
  typename Service<Type>::SharedPtr create_service(
    const std::string &, Callback &&, const QoS & = ServicesQoS(),
    CallbackGroup::SharedPtr = nullptr)
  {
    using Request = std::shared_ptr<typename Type::Request>;
    using Response = std::shared_ptr<typename Type::Response>;
    static_assert(std::is_invocable_v<Callback, Request, Response>, "no callback for a request");
    return nullptr;
  }

  template<typename Type>
  typename Client<Type>::SharedPtr create_client(
    const std::string &, const QoS & = ServicesQoS(), CallbackGroup::SharedPtr = nullptr)
  {
    return nullptr;
  }

protected:
  NodeParts(const std::string & name, const NodeOptions & options);
  NodeParts(const std::string & name, const std::string & space, const NodeOptions & options);
  virtual ~NodeParts();
};

class Node : public NodeParts
{
public:
  explicit Node(const std::string & name, const NodeOptions & options = NodeOptions());
  Node(
    const std::string & name, const std::string & space,
    const NodeOptions & options = NodeOptions());
  ~Node() override;

  template<typename Message>
  typename Publisher<Message>::SharedPtr create_publisher(const std::string &, const QoS &)
  {
    return nullptr;
  }
};

template<typename AnyNode, typename Callback>
TimerBase::SharedPtr create_timer(
  AnyNode, Clock::SharedPtr, Duration, Callback &&, CallbackGroup::SharedPtr = nullptr)
{
  static_assert(std::is_invocable_v<Callback>, "no callback for a timer");
  return nullptr;
}

struct ExecutorOptions
{
};

namespace executors
{

class SingleThreadedExecutor
{
public:
  void add_node(node_interfaces::NodeBaseInterface::SharedPtr node);
  void spin();
};

class MultiThreadedExecutor
{
public:
  explicit MultiThreadedExecutor(
    const ExecutorOptions & options = ExecutorOptions(), std::size_t threads = 0);
  void add_node(node_interfaces::NodeBaseInterface::SharedPtr node);
  void spin();
};

}  // namespace executors
}  // namespace rclcpp

#endif  // RCLCPP__RCLCPP_HPP_
