// Messages of every kind, written by the tests `page_types` of slipfront-session: with UPDATE=1 anew.
import { Replies, Requests, Texture } from './protocol';
import { Samples, Some } from './sample_lists';

export const requests = {
  open: [
    {"do":"open","source":{}},
    {"do":"open","source":{"preset":"circle"}},
    {"do":"open","source":{"folder":"run"}},
    {"do":"open","source":{"toml":"","name":"case","files":{"mask.png":""}}},
    {"do":"open","source":{"run":{"manifest.json":""}}},
  ],
  set: [
    {"do":"set","keys":{"drive.v_star":0.1,"load.pressure":"1 MPa","drive.held":true,"slider.blocks":[50,50],"output":{"snapshots":"auto"},"texture":[{"shape":"cavity","coverage":5}],"friction.seed":null},"gesture":1},
  ],
  paint: [
    {"do":"paint","points":[[0.5,0.5]],"radius":0.5,"textured":true,"gesture":1},
  ],
  image: [
    {"do":"image","png":"","threshold":0.5,"gesture":1},
  ],
  undo: [
    {"do":"undo"},
  ],
  redo: [
    {"do":"redo"},
  ],
  rest: [
    {"do":"rest"},
  ],
  view: [
    {"do":"view"},
    {"do":"view","field":"contact_stress","visible":true,"after_change":"rest"},
    {"do":"view","field":"traction","paused":true,"after_change":"go_on"},
    {"do":"view","field":"displacement","pace":25},
    {"do":"view","field":"speed","loading_pace":0},
    {"do":"view","field":"sliding","twin":true},
    {"do":"view","field":"first_slip","kymograph":true},
    {"do":"view","field":"front"},
    {"do":"view","frames_per_second":60},
    {"do":"view","probe":[1,1]},
    {"do":"view","probe":null},
  ],
  step: [
    {"do":"step","count":1},
  ],
  repeat: [
    {"do":"repeat","seeds":1},
  ],
  find: [
    {"do":"find","gesture":1},
  ],
  find_stop: [
    {"do":"find_stop"},
  ],
  save: [
    {"do":"save","name":"run"},
  ],
  save_stop: [
    {"do":"save_stop","name":"run"},
  ],
  export: [
    {"do":"export"},
  ],
  frames_of: [
    {"do":"frames_of","index":1},
    {"do":"frames_of","index":null},
  ],
  read_record: [
    {"do":"read_record","record":{"name":"rig.csv","bytes":""}},
    {"do":"read_record","record":{"name":"rig.csv","bytes":"","x":"1","y":"2","x_unit":"ms","y_unit":"N"}},
  ],
  calibrate: [
    {"do":"calibrate","record":{"name":"rig.csv","bytes":""},"shift":0.5,"noise":0.01,"runs":200,"unknowns":{"friction.r_star":[0.4,0.9],"drive.total_stiffness":{"from":"80 N/m","to":"350 N/m","scale":"log"}}},
    {"do":"calibrate","record":{"name":"rig.csv","bytes":"","x":"1","y":"2","x_unit":"ms","y_unit":"N"},"shift":0.5,"from":0.5,"to":1.5,"noise":0.01,"runs":200,"unknowns":{}},
  ],
  calibrate_stop: [
    {"do":"calibrate_stop"},
  ],
  sensitivity: [
    {"do":"sensitivity","control":"load"},
  ],
  drawing: [
    {"do":"drawing","format":"dxf"},
    {"do":"drawing","format":"svg"},
  ],
} satisfies Samples<Requests, 'do'>;

export const replies = {
  calibrated: [
    {"is":"calibrated","outcome":"done","sentence":null,"results":{"unknowns":[{"key":"friction.r_star","unit":null,"median":0.5,"interval":[0.4,0.6],"range":[0.25,0.75],"is_determined":true},{"key":"friction.r_star","unit":"N/m","median":0.5,"interval":[0.4,0.6],"range":[0.25,0.75],"is_determined":true}],"is_refused":false,"report":"a report","toml":"[base]","set":{"friction.r_star":0.5}}},
    {"is":"calibrated","outcome":"stopped","sentence":null,"results":null},
    {"is":"calibrated","outcome":"given_up","sentence":null,"results":null},
    {"is":"calibrated","outcome":"failed","sentence":"why","results":null},
  ],
  calibrating: [
    {"is":"calibrating","stage":"training","runs":1,"of":360},
    {"is":"calibrating","stage":"closest","runs":1,"of":360},
    {"is":"calibrating","stage":"prediction","runs":1,"of":360},
    {"is":"calibrating","stage":"other_step","runs":1,"of":360},
  ],
  case: [
    {"is":"case","name":"case","toml":"[[texture]]\npoints = [[\"10 um\", \"10 um\"], [\"20 um\", \"10 um\"], [\"10 um\", \"20 um\"]]\nshape = \"polygon\"\n","files":["mask.png"],"link_files_bytes":1,"blocks":[50,50],"block_size_m":1e-6,"n_blocks":2500,"texture_percent":5.0,"texture":[{"points":[["10 um","10 um"],["20 um","10 um"],["10 um","20 um"]],"shape":"polygon"}],"shapes":[{"index":0,"outlines":[[[10.0,10.0],[20.0,10.0],[10.0,20.0]]]}],"values":{"r_star":{"star":0.5,"si":null},"speed":{"star":0.1,"si":0.5}},"units":{"time_s":1.0,"displacement_m":1.0,"speed_m_s":1.0,"stress_pa":1.0,"friction_n":0.5,"friction_coefficient":0.5},"dt_star":0.1,"duration_star":400.0,"kinetic_from_star":1.0,"onset_star":80.0,"drive_degrees":30.0,"loading_rate":0.01,"steady_level":0.5,"can_undo":true,"can_redo":false,"leg":0,"why":"open","time_before_s":0.0,"twin":true,"has_memory":false,"mesh":"the block decides","warnings":["a warning"],"too_coarse":null,"seeds":"a note","search":{"width_blocks":4,"most_percent":30.0}},
    {"is":"case","name":"case","toml":"[[texture]]\npoints = [[\"10 um\", \"10 um\"], [\"20 um\", \"10 um\"], [\"10 um\", \"20 um\"]]\nshape = \"polygon\"\n","files":["mask.png"],"link_files_bytes":1,"blocks":[50,50],"block_size_m":1e-6,"n_blocks":2500,"texture_percent":5.0,"texture":[{"points":[["10 um","10 um"],["20 um","10 um"],["10 um","20 um"]],"shape":"polygon"}],"shapes":[{"index":0,"outlines":[[[10.0,10.0],[20.0,10.0],[10.0,20.0]]]}],"values":{"r_star":{"star":0.5,"si":null},"speed":{"star":0.1,"si":0.5}},"units":{"time_s":1.0,"displacement_m":1.0,"speed_m_s":1.0,"stress_pa":1.0,"friction_n":null,"friction_coefficient":0.5},"dt_star":0.1,"duration_star":400.0,"kinetic_from_star":null,"onset_star":80.0,"drive_degrees":null,"loading_rate":null,"steady_level":0.5,"can_undo":true,"can_redo":false,"leg":0,"why":"open","time_before_s":0.0,"twin":true,"has_memory":false,"mesh":"the block decides","warnings":["a warning"],"too_coarse":"too coarse","seeds":null,"search":{"width_blocks":4,"most_percent":30.0}},
  ],
  curve: [
    {"is":"curve","leg":0,"from_rest":true,"t":[0.5],"mu":[0.5],"sliding":[0.5],"twin_reset":false,"twin_t":[0.5],"twin_mu":[0.5]},
    {"is":"curve","leg":0,"from_rest":true,"t":[0.5],"mu":[0.5],"sliding":[0.5],"twin_reset":false,"twin_t":[0.5],"twin_mu":[0.5],"recorded_t":[0.5],"recorded_mu":[0.5]},
  ],
  drawing: [
    {"is":"drawing","format":"dxf","text":"","notes":["a note"]},
    {"is":"drawing","format":"svg","text":"","notes":["a note"]},
  ],
  exported: [
    {"is":"exported","toml":"","files":{"mask.png":""},"zip":""},
  ],
  failed: [
    {"is":"failed","sentence":""},
  ],
  finding: [
    {"is":"finding","seconds":1.0,"of_seconds":60.0,"textures":32,"compares":false,"best_percent":null,"best_texture":[[0,1,4]]},
    {"is":"finding","seconds":1.0,"of_seconds":60.0,"textures":32,"compares":false,"best_percent":0.5,"best_texture":[[0,1,4]]},
  ],
  found: [
    {"is":"found","outcome":"replaced","textures":32,"surfaces":8,"best":null,"painted":null},
    {"is":"found","outcome":"kept","textures":32,"surfaces":8,"best":{"mean":-30.0,"half_width":null},"painted":{"mean":-30.0,"half_width":null}},
    {"is":"found","outcome":"given_up","textures":32,"surfaces":8,"best":null,"painted":null},
    {"is":"found","outcome":"failed","textures":32,"surfaces":8,"best":null,"painted":null},
    {"is":"found","outcome":"replaced","textures":32,"surfaces":8,"best":null,"painted":null},
    {"is":"found","outcome":"kept","textures":32,"surfaces":8,"best":{"mean":-30.0,"half_width":0.5},"painted":{"mean":-30.0,"half_width":0.5}},
    {"is":"found","outcome":"given_up","textures":32,"surfaces":8,"best":null,"painted":null},
    {"is":"found","outcome":"failed","textures":32,"surfaces":8,"best":null,"painted":null},
  ],
  hello: [
    {"is":"hello","version":"1","presets":[{"name":"circle","group":"holes","picture":"","is_study":false,"title":"A circle"}],"folders":["run"],"results":null,"max_blocks":1,"controls":[{"id":"speed","key":"drive.v_star","si_key":"drive.speed","unit":"m/s","min":0.003,"max":0.3,"logarithmic":true,"whole":false},{"id":"load","key":"load.pressure","si_key":"load.pressure","unit":"Pa","min":1000.0,"max":100000000.0,"logarithmic":true,"whole":false},{"id":"r_star","key":"friction.r_star","si_key":null,"unit":"","min":0.0,"max":1.0,"logarithmic":false,"whole":false}]},
    {"is":"hello","version":"1","presets":[{"name":"circle","group":"holes","picture":"","is_study":false,"title":"A circle"}],"folders":["run"],"results":"results","max_blocks":1,"controls":[{"id":"speed","key":"drive.v_star","si_key":"drive.speed","unit":"m/s","min":0.003,"max":0.3,"logarithmic":true,"whole":false},{"id":"load","key":"load.pressure","si_key":"load.pressure","unit":"Pa","min":1000.0,"max":100000000.0,"logarithmic":true,"whole":false},{"id":"r_star","key":"friction.r_star","si_key":null,"unit":"","min":0.0,"max":1.0,"logarithmic":false,"whole":false}]},
  ],
  numbers: [
    {"is":"numbers","step":1,"t_star":0.5,"time_s":0.5,"mu_star":0.5,"sliding_percent":0.5,"peak":{"t_star":1.0,"mu_star":1.0,"certain":true},"twin_peak":{"t_star":1.0,"mu_star":1.0,"certain":true},"change_percent":0.5,"kinetic":0.5,"instants":{"A":0.5},"crossed":false,"steps_per_second":0.5,"ended":true,"summary":{"energy_error":0.0,"front_duration_star":null,"front_speed_c_s":null,"front_speed_m_s":null,"kinetic_friction_star":null,"nucleation_sites":null,"onset_time_star":0.0,"static_friction_star":0.0,"transition":false}},
    {"is":"numbers","step":1,"t_star":0.5,"time_s":0.5,"mu_star":0.5,"sliding_percent":0.5,"peak":{"t_star":1.0,"mu_star":1.0,"certain":true},"twin_peak":{"t_star":1.0,"mu_star":1.0,"certain":true},"change_percent":0.5,"kinetic":0.5,"instants":{"A":0.5},"crossed":false,"steps_per_second":0.5,"ended":true,"summary":{"energy_error":0.0,"front_duration_star":0.5,"front_speed_c_s":0.5,"front_speed_m_s":0.5,"kinetic_friction_star":0.5,"nucleation_sites":1,"onset_time_star":0.0,"static_friction_star":0.0,"transition":false}},
    {"is":"numbers","step":1,"t_star":0.5,"time_s":0.5,"mu_star":0.5,"sliding_percent":0.5,"peak":null,"twin_peak":null,"change_percent":null,"kinetic":null,"instants":{"A":0.5},"crossed":false,"steps_per_second":0.5,"ended":true,"summary":null},
  ],
  probe: [
    {"is":"probe","block":[0,0],"exists":true,"textured":true,"sliding":true,"mu_static":0.5,"mu_kinetic":0.5,"contact_stress_pa":0.5,"traction_pa":0.5,"displacement_m":0.5,"speed_m_s":0.5,"first_slip_star":0.5},
    {"is":"probe","block":[0,0],"exists":true,"textured":true,"sliding":true,"mu_static":0.5,"mu_kinetic":0.5,"contact_stress_pa":0.5,"traction_pa":0.5,"displacement_m":0.5,"speed_m_s":0.5,"first_slip_star":0.5},
    {"is":"probe","block":[0,0],"exists":true,"textured":true,"sliding":true,"mu_static":0.5,"mu_kinetic":0.5,"contact_stress_pa":0.5,"traction_pa":0.5,"displacement_m":0.5,"speed_m_s":0.5,"first_slip_star":null},
  ],
  record: [
    {"is":"record","name":"rig.csv","columns":[{"name":"t","unit":"s"}],"curve":{"columns":[0,1],"along":"time","of":"force","values":1,"x":[0.5],"y":[0.5],"noise_percent":0.5},"problem":null,"notes":["a note"]},
    {"is":"record","name":"rig.csv","columns":[{"name":"t","unit":"s"}],"curve":null,"problem":"no unit","notes":["a note"]},
    {"is":"record","name":"rig.csv","columns":[{"name":"t","unit":null}],"curve":{"columns":[0,1],"along":"displacement","of":"coefficient","values":1,"x":[0.5],"y":[0.5],"noise_percent":0.5},"problem":null,"notes":["a note"]},
    {"is":"record","name":"rig.csv","columns":[{"name":"t","unit":null}],"curve":null,"problem":"no unit","notes":["a note"]},
  ],
  recorded: [
    {"is":"recorded","times_star":[0.5]},
  ],
  refused: [
    {"is":"refused","of":"set","sentence":""},
  ],
  repeated: [
    {"is":"repeated","done":1,"of":2,"finished":false,"change_percent":{"mean":0.5,"half_width":null},"with":{"mean":0.5,"half_width":null},"without":{"mean":0.5,"half_width":null},"without_transition":0},
    {"is":"repeated","done":1,"of":2,"finished":false,"change_percent":{"mean":0.5,"half_width":0.5},"with":{"mean":0.5,"half_width":0.5},"without":{"mean":0.5,"half_width":0.5},"without_transition":0},
    {"is":"repeated","done":1,"of":2,"finished":false,"change_percent":{"mean":0.5,"half_width":null},"with":{"mean":0.5,"half_width":null},"without":{"mean":0.5,"half_width":null},"without_transition":0},
    {"is":"repeated","done":1,"of":2,"finished":false,"change_percent":{"mean":0.5,"half_width":0.5},"with":{"mean":0.5,"half_width":0.5},"without":{"mean":0.5,"half_width":0.5},"without_transition":0},
    {"is":"repeated","done":1,"of":2,"finished":false,"change_percent":null,"with":null,"without":null,"without_transition":0},
    {"is":"repeated","done":1,"of":2,"finished":false,"change_percent":null,"with":null,"without":null,"without_transition":0},
  ],
  saved: [
    {"is":"saved","name":"run","folder":"results/run","folders":["run"]},
  ],
  saving: [
    {"is":"saving","under_way":[{"name":"run","share":0.5}]},
  ],
  sensitivity: [
    {"is":"sensitivity","control":"load","values":[1000000.0,1100000.0],"percent":null},
    {"is":"sensitivity","control":"load","values":[1000000.0,1100000.0],"percent":0.5},
  ],
} satisfies Samples<Replies, 'is'>;

export const textures = [
  {"shape":"cavity"},
  {"shape":"cavity","s":1},
  {"shape":"cavity","w":0.1},
  {"shape":"cavity","coverage":1},
  {"shape":"cavity","lambda":"text"},
  {"shape":"cavity","across":true},
  {"shape":"cavity","center":"1 um"},
  {"shape":"cavity","center":["1 um","1 um"]},
  {"shape":"cavity","rotate":1},
  {"shape":"cavity","pitch":"1 um"},
  {"shape":"cavity","pitch":["1 um","1 um"]},
  {"shape":"cavity","array":"auto"},
  {"shape":"cavity","array":[3,3]},
  {"shape":"cavity","lattice":"text"},
  {"shape":"cavity","repeat":{"array":[3,3]}},
  {"shape":"cavity","invert":true},
  {"shape":"groove"},
  {"shape":"groove","orientation":"text"},
  {"shape":"groove","coverage":1},
  {"shape":"groove","width":"text"},
  {"shape":"groove","offset":"text"},
  {"shape":"groove","pitch":"1 um"},
  {"shape":"groove","pitch":["1 um","1 um"]},
  {"shape":"groove","array":"auto"},
  {"shape":"groove","array":[3,3]},
  {"shape":"groove","lattice":"text"},
  {"shape":"groove","repeat":{"array":[3,3]}},
  {"shape":"groove","invert":true},
  {"shape":"polygon"},
  {"shape":"polygon","points":[["0 um","0 um"],["1 um","0 um"],["0 um","1 um"]]},
  {"shape":"polygon","pitch":"1 um"},
  {"shape":"polygon","pitch":["1 um","1 um"]},
  {"shape":"polygon","array":"auto"},
  {"shape":"polygon","array":[3,3]},
  {"shape":"polygon","lattice":"text"},
  {"shape":"polygon","repeat":{"array":[3,3]}},
  {"shape":"polygon","invert":true},
  {"shape":"mask"},
  {"shape":"mask","file":"text"},
  {"shape":"mask","threshold":1},
  {"shape":"mask","pitch":"1 um"},
  {"shape":"mask","pitch":["1 um","1 um"]},
  {"shape":"mask","array":"auto"},
  {"shape":"mask","array":[3,3]},
  {"shape":"mask","lattice":"text"},
  {"shape":"mask","repeat":{"array":[3,3]}},
  {"shape":"mask","invert":true},
  {"shape":"height_map"},
  {"shape":"height_map","file":"text"},
  {"shape":"height_map","bearing_percent":1},
  {"shape":"height_map","depth":"text"},
  {"shape":"height_map","reference":"text"},
  {"shape":"height_map","height_unit":"text"},
  {"shape":"height_map","pixel_size":"1 um"},
  {"shape":"height_map","pixel_size":["1 um","1 um"]},
  {"shape":"height_map","level":"text"},
  {"shape":"height_map","decimal":"text"},
  {"shape":"height_map","separator":"text"},
  {"shape":"height_map","missing":-9999},
  {"shape":"height_map","missing":"nan"},
  {"shape":"height_map","pitch":"1 um"},
  {"shape":"height_map","pitch":["1 um","1 um"]},
  {"shape":"height_map","array":"auto"},
  {"shape":"height_map","array":[3,3]},
  {"shape":"height_map","lattice":"text"},
  {"shape":"height_map","repeat":{"array":[3,3]}},
  {"shape":"height_map","invert":true},
  {"shape":"drawing"},
  {"shape":"drawing","file":"text"},
  {"shape":"drawing","pitch":"1 um"},
  {"shape":"drawing","pitch":["1 um","1 um"]},
  {"shape":"drawing","array":"auto"},
  {"shape":"drawing","array":[3,3]},
  {"shape":"drawing","lattice":"text"},
  {"shape":"drawing","repeat":{"array":[3,3]}},
  {"shape":"drawing","invert":true},
] satisfies Some<Texture>;
