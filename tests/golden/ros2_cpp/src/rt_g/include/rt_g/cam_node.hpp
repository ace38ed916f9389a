// Made by archgen from cam.
// What the node does stands in cam_behaviour.cpp.

#ifndef RT_G__CAM_NODE_HPP_
#define RT_G__CAM_NODE_HPP_

#include <memory>
#include <vector>

#include "rclcpp/rclcpp.hpp"
#include "sensor_msgs/msg/image.hpp"
#include "sensor_msgs/msg/point_cloud2.hpp"
#include "rt_g/cam_parameters.hpp"

namespace rt_g
{

class CamBehaviour;

/// Camera.
class Cam : public rclcpp::Node
{
public:
  /// Declare the parameters, and create what the node uses.
  explicit Cam(const rclcpp::NodeOptions & options = rclcpp::NodeOptions());

  ~Cam() override;

  /// Return the values that its parameters have now.
  cam_parameters::Params read_parameters() const;

  /// Publish g.cam.cloud.
  void publish_cloud(const sensor_msgs::msg::PointCloud2 & message);

  /// Publish it, without a copy where its container has intra-process communication on.
  void publish_cloud(sensor_msgs::msg::PointCloud2::UniquePtr message);

  /// Publish g.cam.image.
  void publish_image(const sensor_msgs::msg::Image & message);

  /// Publish it, without a copy where its container has intra-process communication on.
  void publish_image(sensor_msgs::msg::Image::UniquePtr message);

private:
  void declare_own_parameters();
  rcl_interfaces::msg::SetParametersResult check_choices(
    const std::vector<rclcpp::Parameter> & parameters) const;
  void create_interfaces();

  std::unique_ptr<cam_parameters::ParamListener> parameter_listener_;
  OnSetParametersCallbackHandle::SharedPtr choices_handle_;
  PostSetParametersCallbackHandle::SharedPtr values_handle_;
  rclcpp::Publisher<sensor_msgs::msg::PointCloud2>::SharedPtr cloud_publisher_;
  rclcpp::Publisher<sensor_msgs::msg::Image>::SharedPtr image_publisher_;
  std::unique_ptr<CamBehaviour> behaviour_;
  rclcpp::TimerBase::SharedPtr timer_;
};

}  // namespace rt_g

#endif  // RT_G__CAM_NODE_HPP_
