#pragma once

#include <fiimap/MapInfo.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <boost/shared_ptr.hpp>
#include <memory>

#include "fiimap/map_handle.h"

namespace fiimap {

/// What the mapping nodelet publishes on ~map_handle at every update, latched. A nodelet of the
/// same manager that subscribes with MapHandleMessage::ConstPtr receives the handle, early or late,
/// and may ask it for the newest snapshot whenever it likes, also between messages. On the wire it
/// is a plain fiimap/MapInfo: subscribers in other processes, and readers of bags, have a null
/// handle.
struct MapHandleMessage {
  ///@{
  /// As of any message of roscpp.
  using Ptr = boost::shared_ptr<MapHandleMessage>;
  using ConstPtr = boost::shared_ptr<const MapHandleMessage>;
  ///@}

  MapInfo info;                             ///< of the newest snapshot
  std::shared_ptr<const MapHandle> handle;  ///< null in other processes
};

}  // namespace fiimap

/// \cond for roscpp, which nobody else needs to read
namespace ros {
namespace message_traits {

template <>
struct MD5Sum<fiimap::MapHandleMessage> {
  static const char* value() { return MD5Sum<fiimap::MapInfo>::value(); }
  static const char* value(const fiimap::MapHandleMessage&) { return value(); }
};
template <>
struct DataType<fiimap::MapHandleMessage> {
  static const char* value() { return DataType<fiimap::MapInfo>::value(); }
  static const char* value(const fiimap::MapHandleMessage&) { return value(); }
};
template <>
struct Definition<fiimap::MapHandleMessage> {
  static const char* value() { return Definition<fiimap::MapInfo>::value(); }
  static const char* value(const fiimap::MapHandleMessage&) { return value(); }
};
template <>
struct TimeStamp<fiimap::MapHandleMessage> {
  static ros::Time* pointer(fiimap::MapHandleMessage& m) { return &m.info.header.stamp; }
  static const ros::Time* pointer(const fiimap::MapHandleMessage& m) {
    return &m.info.header.stamp;
  }
  static ros::Time value(const fiimap::MapHandleMessage& m) { return m.info.header.stamp; }
};
template <>
struct FrameId<fiimap::MapHandleMessage> {
  static std::string* pointer(fiimap::MapHandleMessage& m) { return &m.info.header.frame_id; }
  static const std::string* pointer(const fiimap::MapHandleMessage& m) {
    return &m.info.header.frame_id;
  }
  static std::string value(const fiimap::MapHandleMessage& m) { return m.info.header.frame_id; }
};

}  // namespace message_traits

namespace serialization {

template <>
struct Serializer<fiimap::MapHandleMessage> {
  template <typename Stream>
  static void write(Stream& stream, const fiimap::MapHandleMessage& message) {
    stream.next(message.info);
  }
  template <typename Stream>
  static void read(Stream& stream, fiimap::MapHandleMessage& message) {
    stream.next(message.info);
    // ROS sends the latched message as bytes to late subscribers of the same process, too.
    message.handle = fiimap::MapRegistry::find(message.info.id);
  }
  static std::uint32_t serializedLength(const fiimap::MapHandleMessage& message) {
    return serializationLength(message.info);
  }
};

}  // namespace serialization
}  // namespace ros
/// \endcond
