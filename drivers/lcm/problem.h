/* SPDX-License-Identifier: MIT */
/** @file problem.h
 *  What publisher and subscriber have in common: the default network and why one cannot be made. */
#ifndef UNISIM_DRIVERS_LCM_PROBLEM_H
#define UNISIM_DRIVERS_LCM_PROBLEM_H

/** LCM's own default: this machine only. ttl=1 reaches the machines on the same network. */
#define UNISIM_LCM_DEFAULT_URL "udpm://239.255.76.67:7667?ttl=0"

/** Why a publisher or subscriber could not be made. */
#define UNISIM_LCM_OK 0
#define UNISIM_LCM_BAD_CONFIG 1 /**< URL, channel or a field makes no sense */
#define UNISIM_LCM_NO_NETWORK 2 /**< no route for multicast, or it cannot be opened */
#define UNISIM_LCM_NOT_BUILT 3  /**< this build was made without LCM */
#define UNISIM_LCM_NO_MEMORY 4

#endif
