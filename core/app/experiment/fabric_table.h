#pragma once

namespace drape {

/// The fabrics that come with drape, as a CSV file: figures of publications, in SI units. An empty cell is
/// not known. Bending is that at small curvature; warp is the first direction of the source, or the mean of
/// both.
inline constexpr const char* fabric_table =
    R"(name,mass,thickness,membrane_modulus,bending_modulus,poisson_ratio,warp_bending,weft_bending,bias_bending,bending_hysteresis,source
cotton,0.1503,3.18e-4,0.821e6,0.821e6,0.243,,,,,Li et al. 2021 (C-IPC) after Penava et al. 2014
wool-lycra,0.1782,3.28e-4,0.076e6,0.076e6,0.071,,,,,Li et al. 2021 (C-IPC) after Penava et al. 2014
ivory-rib-knit,0.276,,,,,46.24e-6,32.24e-6,30.02e-6,,Wang et al. 2011; cotton and spandex: underwear
pink-ribbon-brown,0.228,,,,,117.07e-6,59.77e-6,87.51e-6,,Wang et al. 2011; polyester: blanket
white-dots-on-blk,0.128,,,,,51.71e-6,31.28e-6,40.66e-6,,Wang et al. 2011; polyester: tablecloth
navy-sparkle-sweat,0.224,,,,,59.47e-6,45.63e-6,40.07e-6,,Wang et al. 2011; polyester and spandex: sweater
camel-ponte-roma,0.284,,,,,36.35e-6,37.16e-6,33.01e-6,,Wang et al. 2011; polyester and rayon: jacket
gray-interlock,0.187,,,,,23.19e-6,14.27e-6,24.75e-6,,Wang et al. 2011; cotton and polyester: t-shirt
11oz-black-denim,0.324,,,,,64.20e-6,96.95e-6,73.38e-6,,Wang et al. 2011; cotton and spandex: jeans
white-swim-solid,0.204,,,,,60.24e-6,51.02e-6,58.80e-6,,Wang et al. 2011; nylon and spandex: swimsuit
tango-red-jet-set,0.113,,,,,14.29e-6,20.35e-6,21.95e-6,,Wang et al. 2011; polyester: jacket
royal-target,0.220,,,,,125.41e-6,125.41e-6,108.00e-6,,Wang et al. 2011; cotton and polyester: trousers
cotton-broad,0.1238,4.97e-4,,,,11.57e-6,,,1.216e-3,Matsudaira et al. 2015; cotton broadcloth; drape coefficient 82.9 %
wool-tropical,0.1629,4.07e-4,,,,6.57e-6,,,0.3236e-3,Matsudaira et al. 2015; wool tropical; drape coefficient 49.8 %
polyester-tropical,0.1165,3.40e-4,,,,7.55e-6,,,0.2844e-3,Matsudaira et al. 2015; polyester tropical; drape coefficient 50.7 %
polyester-faille,0.1043,2.26e-4,,,,1.86e-6,,,0.06865e-3,Matsudaira et al. 2015; polyester faille; drape coefficient 28.3 %
)";

}  // namespace drape
