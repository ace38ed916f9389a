// Made by archgen from archgen.yaml:37:3.

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
    // archgen.yaml:15:54
    rcl_interfaces::msg::ParameterDescriptor descriptor;
    declare_parameter(
      "lens.class",
      rclcpp::ParameterValue(std::int64_t{3}),
      descriptor);
  }
  {
    // archgen.yaml:16:11
    rcl_interfaces::msg::ParameterDescriptor descriptor;
    descriptor.additional_constraints =
      "One of say \"hello\", bye";
    declare_parameter(
      "greeting",
      rclcpp::ParameterValue(std::string("say \"hello\"")),
      descriptor);
  }
  {
    // archgen.yaml:18:11
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
  // g.cam.image
  image_publisher_ = create_publisher<sensor_msgs::msg::Image>(
    "/camera/image",
    rclcpp::QoS(rclcpp::KeepLast(5))
    .best_effort()
    .durability_volatile());
  // g.cam.cloud
  cloud_publisher_ = create_publisher<sensor_msgs::msg::PointCloud2>(
    "/g/cam/cloud",
    rclcpp::QoS(rclcpp::KeepLast(10))
    .reliable()
    .durability_volatile());
  // g.cam
  timer_ = rclcpp::create_timer(
    this,
    get_clock(),
    rclcpp::Duration::from_nanoseconds(100000000),
    [this]() {behaviour_->on_timer();});
}

void Cam::publish_image(const sensor_msgs::msg::Image & message)
{
  image_publisher_->publish(message);
}

void Cam::publish_image(sensor_msgs::msg::Image::UniquePtr message)
{
  image_publisher_->publish(std::move(message));
}

void Cam::publish_cloud(const sensor_msgs::msg::PointCloud2 & message)
{
  cloud_publisher_->publish(message);
}

void Cam::publish_cloud(sensor_msgs::msg::PointCloud2::UniquePtr message)
{
  cloud_publisher_->publish(std::move(message));
}

}  // namespace rt_g

RCLCPP_COMPONENTS_REGISTER_NODE(rt_g::Cam)
