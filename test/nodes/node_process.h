#pragma once

#include <gtest/gtest.h>
#include <ros/network.h>
#include <ros/ros.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>
#include <xmlrpcpp/XmlRpc.h>

#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>

namespace arfm_vo {

/// The process of a node, as the node itself tells it.
inline pid_t PidOf(const std::string& node) {
  XmlRpc::XmlRpcValue request, response, payload;
  request[0] = ros::this_node::getName();
  request[1] = node;
  EXPECT_TRUE(ros::master::execute("lookupNode", request, response, payload, false));
  std::string host;
  uint32_t port = 0;
  EXPECT_TRUE(ros::network::splitURI(payload, host, port));
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  XmlRpc::XmlRpcValue caller, answer;
  caller[0] = ros::this_node::getName();
  EXPECT_TRUE(client.execute("getPid", caller, answer));
  return static_cast<int>(answer[2]);
}

/// What a program prints until it ends; fills its exit status.
inline std::string Finish(FILE* program, int& status) {
  std::string text;
  for (char buffer[500]; std::fgets(buffer, sizeof(buffer), program);) text += buffer;
  status = WEXITSTATUS(pclose(program));
  return text;
}

/// Processor time of a process so far, s.
inline double CpuSeconds(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  std::getline(file, text);
  std::istringstream fields(text.substr(text.rfind(')') + 1));  // from "state", the third
  std::string field;
  for (int i = 3; i < 14; ++i) fields >> field;
  double user = 0, system = 0;
  fields >> user >> system;
  EXPECT_TRUE(fields) << "no process " << pid;
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

}  // namespace arfm_vo
