#pragma once
#include <cstddef>
#include <cstdint>
#define PLAYER_MSGQUEUE_DEFAULT_MAXLEN 32
#define PLAYER_MSGTYPE_DATA 1
#define PLAYER_MSGTYPE_CMD 2
#define PLAYER_MSGTYPE_REQ 3
#define PLAYER_MSGTYPE_RESP_ACK 4
#define PLAYER_OPAQUE_CODE 51
#define PLAYER_OPAQUE_DATA_STATE 1
#define PLAYER_OPAQUE_CMD_DATA 1
#define PLAYER_OPAQUE_REQ_DATA 1
#define PLAYER_POSITION2D_CODE 4
#define PLAYER_POSITION2D_DATA_STATE 1
#define PLAYER_POSITION2D_CMD_VEL 1
typedef struct player_opaque_data { uint32_t data_count; uint8_t * data; } player_opaque_data_t;
typedef struct player_pose2d { double px, py, pa; } player_pose2d_t;
typedef struct player_position2d_data { player_pose2d_t pos; player_pose2d_t vel; uint8_t stall; } player_position2d_data_t;
typedef struct player_position2d_cmd_vel { player_pose2d_t vel; uint8_t state; } player_position2d_cmd_vel_t;
typedef struct player_devaddr { uint32_t host; uint32_t robot; uint16_t interf; uint16_t index; } player_devaddr_t;
typedef struct player_msghdr { player_devaddr_t addr; uint8_t type; uint8_t subtype; double timestamp; uint32_t seq; uint32_t size; } player_msghdr_t;
class QueuePointer {};
class Message {
public:
  ~Message();
  static bool MatchMessage(player_msghdr_t * header, int type, int subtype, player_devaddr_t address);
  void * GetPayload();
  player_msghdr_t * GetHeader();
};
class Device {
public:
  int Subscribe(QueuePointer & queue);
  int Unsubscribe(QueuePointer & queue);
  void PutMsg(QueuePointer & queue, uint8_t type, uint8_t subtype, void * body, size_t deprecated, double * timestamp);
  Message * Request(
    QueuePointer & queue, uint8_t type, uint8_t subtype, void * body, size_t deprecated, double * timestamp, bool threaded = true);
};
class DeviceTable { public: Device * GetDevice(player_devaddr_t address, bool lookup_remote = true); };
extern DeviceTable * deviceTable;
class ConfigFile {
public:
  int ReadDeviceAddr(player_devaddr_t * address, int section, const char * name, int code, int index, const char * key);
  int ReadInt(int section, const char * name, int value);
  double ReadFloat(int section, const char * name, double value);
  int GetTupleCount(int section, const char * name);
  int ReadTupleInt(int section, const char * name, int index, int value);
  double ReadTupleFloat(int section, const char * name, int index, double value);
  const char * ReadTupleString(int section, const char * name, int index, const char * value);
};
class Driver {
public:
  Driver(const Driver &) = delete;
  virtual ~Driver();
  virtual void Publish(
    player_devaddr_t address, QueuePointer & queue, uint8_t type, uint8_t subtype, void * body = NULL, size_t deprecated = 0,
    double * timestamp = NULL, bool copy = true);
  virtual void Publish(
    player_devaddr_t address, uint8_t type, uint8_t subtype, void * body = NULL, size_t deprecated = 0,
    double * timestamp = NULL, bool copy = true);
  virtual int ProcessMessage(QueuePointer & queue, player_msghdr * header, void * data);
  void ProcessMessages();
  QueuePointer InQueue;
protected:
  Driver(ConfigFile * configuration, int section, bool overwrite_cmds, size_t queue_maxlen);
  int AddInterface(player_devaddr_t address);
  void SetError(int code);
  virtual bool Wait(double timeout = 0.0);
  virtual void TestCancel();
};
class ThreadedDriver : public Driver {
public:
  ThreadedDriver(
    ConfigFile * configuration, int section, bool overwrite_cmds = true, size_t queue_maxlen = PLAYER_MSGQUEUE_DEFAULT_MAXLEN);
  virtual void Main(void) = 0;
  virtual int MainSetup(void);
  virtual void MainQuit(void);
  bool Wait(double timeout = 0.0);
protected:
  void TestCancel();
};
class Property { public: virtual ~Property(); };
class BoolProperty : public Property {
public:
  BoolProperty(const char * key, bool value, bool read_only, Driver * driver, ConfigFile * configuration, int section);
  bool GetValue(void) const;
};
class IntProperty : public Property {
public:
  IntProperty(const char * key, int value, bool read_only, Driver * driver, ConfigFile * configuration, int section);
  int GetValue(void) const;
};
class DoubleProperty : public Property {
public:
  DoubleProperty(const char * key, double value, bool read_only, Driver * driver, ConfigFile * configuration, int section);
  double GetValue(void) const;
};
class StringProperty : public Property {
public:
  StringProperty(const char * key, const char * value, bool read_only, Driver * driver, ConfigFile * configuration, int section);
  const char * GetValue(void) const;
};
class DriverTable { public: int AddDriver(const char * name, Driver * (*maker)(ConfigFile *, int)); };
