// What Camera does: written once by archgen, and yours since.

#ifndef RT_G__CAM_BEHAVIOUR_HPP_
#define RT_G__CAM_BEHAVIOUR_HPP_

namespace rt_g
{

class Cam;

/// Takes pictures.
class CamBehaviour
{
public:
  /// Remember the node: it publishes, calls, logs and knows its parameters.
  explicit CamBehaviour(Cam & node);

  /// Do what is done every 0.1 s.
  void on_timer();

private:
  Cam & node_;
};

}  // namespace rt_g

#endif  // RT_G__CAM_BEHAVIOUR_HPP_
