/// The objects of CiA 402 that the profile reads and writes, independent of their names in an EDS.
#pragma once

#include <cstdint>

#include "canopen/od/access.hpp"
#include "canopen/od/object.hpp"

namespace canopen::cia402::object {

template <std::uint16_t Index, class Type, std::uint8_t SubIndex = 0>
using Entry = Object<Index, SubIndex, Type, Access::rw>;

using CommunicationCyclePeriod = Entry<0x1006, std::uint32_t>;
using AbortConnectionOptionCode = Entry<0x6007, std::int16_t>;
using ErrorCode = Entry<0x603F, std::uint16_t>;
using Controlword = Entry<0x6040, std::uint16_t>;
using Statusword = Entry<0x6041, std::uint16_t>;
using VelocityTarget = Entry<0x6042, std::int16_t>;
using VelocityDemand = Entry<0x6043, std::int16_t>;
using VelocityActual = Entry<0x6044, std::int16_t>;
using VelocityMinAmount = Entry<0x6046, std::uint32_t, 1>;
using VelocityMaxAmount = Entry<0x6046, std::uint32_t, 2>;
using VelocityAccelerationSpeed = Entry<0x6048, std::uint32_t, 1>;
using VelocityAccelerationTime = Entry<0x6048, std::uint16_t, 2>;
using VelocityDecelerationSpeed = Entry<0x6049, std::uint32_t, 1>;
using VelocityDecelerationTime = Entry<0x6049, std::uint16_t, 2>;
using VelocityQuickStopSpeed = Entry<0x604A, std::uint32_t, 1>;
using VelocityQuickStopTime = Entry<0x604A, std::uint16_t, 2>;
using SetPointNumerator = Entry<0x604B, std::int16_t, 1>;
using SetPointDenominator = Entry<0x604B, std::int16_t, 2>;
using DimensionNumerator = Entry<0x604C, std::int32_t, 1>;
using DimensionDenominator = Entry<0x604C, std::int32_t, 2>;
using QuickStopOptionCode = Entry<0x605A, std::int16_t>;
using ShutdownOptionCode = Entry<0x605B, std::int16_t>;
using DisableOperationOptionCode = Entry<0x605C, std::int16_t>;
using HaltOptionCode = Entry<0x605D, std::int16_t>;
using FaultReactionOptionCode = Entry<0x605E, std::int16_t>;
using ModesOfOperation = Entry<0x6060, std::int8_t>;
using ModesOfOperationDisplay = Entry<0x6061, std::int8_t>;
using PositionDemandValue = Entry<0x6062, std::int32_t>;
using PositionActualValue = Entry<0x6064, std::int32_t>;
using FollowingErrorWindow = Entry<0x6065, std::uint32_t>;
using FollowingErrorTimeOut = Entry<0x6066, std::uint16_t>;
using PositionWindow = Entry<0x6067, std::uint32_t>;
using PositionWindowTime = Entry<0x6068, std::uint16_t>;
using VelocityDemandValue = Entry<0x606B, std::int32_t>;
using VelocityActualValue = Entry<0x606C, std::int32_t>;
using VelocityWindow = Entry<0x606D, std::uint16_t>;
using VelocityWindowTime = Entry<0x606E, std::uint16_t>;
using VelocityThreshold = Entry<0x606F, std::uint16_t>;
using VelocityThresholdTime = Entry<0x6070, std::uint16_t>;
using TargetTorque = Entry<0x6071, std::int16_t>;
using MaxTorque = Entry<0x6072, std::uint16_t>;
using TorqueDemand = Entry<0x6074, std::int16_t>;
using TorqueActualValue = Entry<0x6077, std::int16_t>;
using TargetPosition = Entry<0x607A, std::int32_t>;
using HomeOffset = Entry<0x607C, std::int32_t>;
using MinPositionLimit = Entry<0x607D, std::int32_t, 1>;
using MaxPositionLimit = Entry<0x607D, std::int32_t, 2>;
using MaxProfileVelocity = Entry<0x607F, std::uint32_t>;
using ProfileVelocity = Entry<0x6081, std::uint32_t>;
using ProfileAcceleration = Entry<0x6083, std::uint32_t>;
using ProfileDeceleration = Entry<0x6084, std::uint32_t>;
using QuickStopDeceleration = Entry<0x6085, std::uint32_t>;
using TorqueSlope = Entry<0x6087, std::uint32_t>;
using HomingMethodCode = Entry<0x6098, std::int8_t>;
using SpeedToSwitch = Entry<0x6099, std::uint32_t, 1>;
using SpeedToZero = Entry<0x6099, std::uint32_t, 2>;
using HomingAcceleration = Entry<0x609A, std::uint32_t>;
using PositionOffset = Entry<0x60B0, std::int32_t>;
using VelocityOffset = Entry<0x60B1, std::int32_t>;
using TorqueOffset = Entry<0x60B2, std::int16_t>;
using TouchProbeFunction = Entry<0x60B8, std::uint16_t>;
using TouchProbeStatus = Entry<0x60B9, std::uint16_t>;
using TouchProbe1Positive = Entry<0x60BA, std::int32_t>;
using TouchProbe1Negative = Entry<0x60BB, std::int32_t>;
using TouchProbe2Positive = Entry<0x60BC, std::int32_t>;
using TouchProbe2Negative = Entry<0x60BD, std::int32_t>;
using InterpolationData = Entry<0x60C1, std::int32_t, 1>;
using InterpolationTimeUnits = Entry<0x60C2, std::uint8_t, 1>;
using InterpolationTimeIndex = Entry<0x60C2, std::int8_t, 2>;
using InterpolationBufferSize = Entry<0x60C4, std::uint32_t, 2>;
using InterpolationBufferClear = Entry<0x60C4, std::uint8_t, 6>;
using TouchProbe1Source = Entry<0x60D0, std::int16_t, 1>;
using TouchProbe2Source = Entry<0x60D0, std::int16_t, 2>;
using PositiveTorqueLimit = Entry<0x60E0, std::uint16_t>;
using NegativeTorqueLimit = Entry<0x60E1, std::uint16_t>;
using FollowingErrorActualValue = Entry<0x60F4, std::int32_t>;
using DigitalInputs = Entry<0x60FD, std::uint32_t>;
using TargetVelocity = Entry<0x60FF, std::int32_t>;

}  // namespace canopen::cia402::object
