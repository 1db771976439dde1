// Messages between the processes of one render.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace lanewise {

class Messenger {
 public:
  virtual ~Messenger() = default;

  virtual uint32_t rank() const = 0;  // of this process, from 0
  virtual uint32_t ranks() const = 0;
  // From any thread, without waiting. Messages from one rank to another arrive whole, and in their order.
  virtual void send(uint32_t to, std::string bytes) = 0;
  // To be called once: handle() gets each message, one at a time, on a thread of the messenger's; it must not throw. Those that came
  // before wait for it.
  virtual void receive(std::function<void(uint32_t from, std::string&& bytes)> handle) = 0;
};

}  // namespace lanewise
