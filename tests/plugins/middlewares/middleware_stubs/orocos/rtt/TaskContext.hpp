#pragma once
#include <memory>
#include <string>
#include <rtt/OperationCaller.hpp>
#include <rtt/Port.hpp>
namespace RTT {
class Documented {
public:
  Documented & doc(const std::string & description);
  Documented & arg(const std::string & name, const std::string & description);
};
class ServiceRequester {
public:
  template<typename Signature> bool addOperationCaller(OperationCaller<Signature> & caller);
};
class Service { public: OperationInterfacePart * getOperation(std::string name); };
class TaskContext {
public:
  ExecutionEngine * engine() const;
  TaskContext * getPeer(const std::string & name) const;
  std::shared_ptr<Service> provides();
  enum TaskState { Init, PreOperational, FatalError, Exception, Stopped, Running, RunTimeError };
  explicit TaskContext(const std::string & name, TaskState initial_state = Stopped);
  TaskContext(const TaskContext &) = delete;
  virtual ~TaskContext();
  virtual bool configure();
  virtual bool start();
  virtual bool stop();
  virtual bool cleanup();
  base::PortInterface & addPort(base::PortInterface & port);
  base::InputPortInterface & addEventPort(base::InputPortInterface & port);
  template<typename T> Documented & addProperty(const std::string & name, T & value);
  template<typename Owner, typename Result, typename... Arguments>
  Documented & addOperation(
    const std::string & name, Result (Owner::* method)(Arguments...), Owner * owner, ExecutionThread thread = ClientThread);
  ServiceRequester * requires();
protected:
  virtual bool configureHook();
  virtual bool startHook();
  virtual void updateHook();
  virtual void stopHook();
  virtual void cleanupHook();
};
}
