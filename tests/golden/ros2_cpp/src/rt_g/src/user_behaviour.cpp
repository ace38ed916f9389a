// What User does: written once by archgen, and yours since.

#include "rt_g/user_behaviour.hpp"

#include "rt_g/user_node.hpp"

namespace people
{

AskerBehaviour::AskerBehaviour(Asker & node)
: node_(node)
{
  RCLCPP_DEBUG(node_.get_logger(), "ready");
}

}  // namespace people
