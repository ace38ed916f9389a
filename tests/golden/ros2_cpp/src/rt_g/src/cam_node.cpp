// Made by archgen from cam.

#include "rt_g/cam_node.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "rt_g/cam_behaviour.hpp"
#include "rclcpp_components/register_node_macro.hpp"

namespace rt_g
{

namespace
{

/// Tell the own class of new values, where it has a method for them.
template<typename Own>
auto tell_values(Own & own, const std::vector<rclcpp::Parameter> & values, int)
-> decltype(own.on_parameters(values))
{
  return own.on_parameters(values);
}

template<typename Own>
void tell_values(Own &, const std::vector<rclcpp::Parameter> &, ...)
{
}

template<typename Value>
bool are_among(const std::vector<Value> & values, const std::vector<Value> & choices)
{
  return std::all_of(
    values.begin(), values.end(), [&choices](const Value & value) {
      return std::find(choices.begin(), choices.end(), value) != choices.end();
    });
}

}  // namespace

Cam::Cam(const rclcpp::NodeOptions & options)
: rclcpp::Node("cam", options)
{
  parameter_listener_ = std::make_unique<cam_parameters::ParamListener>(
    get_node_parameters_interface(), get_logger());
  declare_own_parameters();
  values_handle_ = add_post_set_parameters_callback(
    [this](const std::vector<rclcpp::Parameter> & values) {
      if (behaviour_) {
        tell_values(*behaviour_, values, 0);
      }
    });
  create_interfaces();
  behaviour_ = std::make_unique<CamBehaviour>(*this);
}

Cam::~Cam() = default;

cam_parameters::Params Cam::read_parameters() const
{
  return parameter_listener_->get_params();
}

void Cam::declare_own_parameters()
{
  choices_handle_ = add_on_set_parameters_callback(
    [this](const std::vector<rclcpp::Parameter> & parameters) {
      return check_choices(parameters);
    });
  {
    // g.cam.greeting
    rcl_interfaces::msg::ParameterDescriptor descriptor;
    descriptor.additional_constraints =
      "One of say \"hello\", bye";
    declare_parameter(
      "greeting",
      rclcpp::ParameterValue(std::string("say \"hello\"")),
      descriptor);
  }
  {
    // g.cam.lens.class
    rcl_interfaces::msg::ParameterDescriptor descriptor;
    declare_parameter(
      "lens.class",
      rclcpp::ParameterValue(std::int64_t{3}),
      descriptor);
  }
  {
    // g.cam.map_file
    rcl_interfaces::msg::ParameterDescriptor descriptor;
    descriptor.description =
      "Where it is kept.";
    declare_parameter(
      "map_file",
      rclcpp::ParameterType::PARAMETER_STRING,
      descriptor);
  }
}

rcl_interfaces::msg::SetParametersResult Cam::check_choices(
  const std::vector<rclcpp::Parameter> & parameters) const
{
  rcl_interfaces::msg::SetParametersResult result;
  result.successful = true;
  for (const rclcpp::Parameter & parameter : parameters) {
    if (
      parameter.get_name() == "greeting" &&
      parameter.get_type() == rclcpp::ParameterType::PARAMETER_STRING &&
      !are_among(
        std::vector<std::string>{parameter.as_string()},
        std::vector<std::string>{"say \"hello\"", "bye"}))
    {
      result.successful = false;
      result.reason = "greeting is one of say \"hello\", bye";
    }
  }
  return result;
}

void Cam::create_interfaces()
{
  // g.cam.cloud
  cloud_publisher_ = create_publisher<sensor_msgs::msg::PointCloud2>(
    "cloud",
    rclcpp::QoS(rclcpp::KeepLast(10))
    .reliable()
    .durability_volatile());
  // g.cam.image
  image_publisher_ = create_publisher<sensor_msgs::msg::Image>(
    "image",
    rclcpp::QoS(rclcpp::KeepLast(5))
    .best_effort()
    .durability_volatile());
  // g.cam
  timer_ = rclcpp::create_timer(
    this,
    get_clock(),
    rclcpp::Duration::from_nanoseconds(100000000),
    [this]() {behaviour_->on_timer();});
}

void Cam::publish_cloud(const sensor_msgs::msg::PointCloud2 & message)
{
  cloud_publisher_->publish(message);
}

void Cam::publish_cloud(sensor_msgs::msg::PointCloud2::UniquePtr message)
{
  cloud_publisher_->publish(std::move(message));
}

void Cam::publish_image(const sensor_msgs::msg::Image & message)
{
  image_publisher_->publish(message);
}

void Cam::publish_image(sensor_msgs::msg::Image::UniquePtr message)
{
  image_publisher_->publish(std::move(message));
}

}  // namespace rt_g

RCLCPP_COMPONENTS_REGISTER_NODE(rt_g::Cam)
