"""Collects nodes, meshes and keys into a glTF with one .bin beside it for the meshes."""

import base64
import json
import struct

FLOAT, USHORT = 5126, 5123
VERTICES, INDICES = 34962, 34963


class Blob:
    """The bytes of one buffer, in views that start at multiples of 4."""

    def __init__(self):
        self.data = bytearray()

    def add(self, packed):
        offset = len(self.data)
        self.data += packed + b"\0" * (-len(packed) % 4)
        return offset


class Gltf:
    def __init__(self, bin_name):
        self.doc = {"asset": {"version": "2.0", "generator": "Torsion generate_scenes.py"},
                    "scene": 0, "scenes": [{"name": "scene", "nodes": []}],
                    "nodes": [], "meshes": [], "materials": [], "cameras": [],
                    "accessors": [], "bufferViews": [], "buffers": []}
        self.bin_name = bin_name
        self.blobs = [Blob(), Blob()]  # meshes in a file, keys in the glTF itself

    def view(self, buffer, packed, target=None):
        view = {"buffer": buffer, "byteOffset": self.blobs[buffer].add(packed),
                "byteLength": len(packed)}
        if target:
            view["target"] = target
        self.doc["bufferViews"].append(view)
        return len(self.doc["bufferViews"]) - 1

    def accessor(self, buffer, rows, kind, component=FLOAT, target=None, bounds=False):
        letter = {FLOAT: "f", USHORT: "H"}[component]
        flat = [c for row in rows for c in row]
        accessor = {"bufferView": self.view(buffer, struct.pack(f"<{len(flat)}{letter}", *flat),
                                            target),
                    "componentType": component, "count": len(rows), "type": kind}
        if bounds:
            stored = [struct.unpack("<f", struct.pack("<f", c))[0] for c in flat]
            width = len(rows[0])
            accessor["min"] = [min(stored[i::width]) for i in range(width)]
            accessor["max"] = [max(stored[i::width]) for i in range(width)]
        self.doc["accessors"].append(accessor)
        return len(self.doc["accessors"]) - 1

    def material(self, name, color, metal=0.0, roughness=0.6, glass=False, scattering=0.0, texture=None):
        """texture: of the base colour, a file beside the scene; glass: seen through by the colour's alpha;
        scattering: how much light goes on inside."""
        look = {"baseColorFactor": color, "metallicFactor": metal, "roughnessFactor": roughness}
        material = {"name": name, "pbrMetallicRoughness": look}
        if texture:
            look["baseColorTexture"] = {"index": self.texture(texture)}
        if glass:
            material["alphaMode"] = "BLEND"
        if scattering:
            extension = "KHR_materials_diffuse_transmission"
            material["extensions"] = {extension: {"diffuseTransmissionFactor": scattering}}
            if extension not in self.doc.setdefault("extensionsUsed", []):
                self.doc["extensionsUsed"].append(extension)
        self.doc["materials"].append(material)
        return len(self.doc["materials"]) - 1

    def texture(self, uri):
        images = self.doc.setdefault("images", [])
        if {"uri": uri} not in images:
            images.append({"uri": uri})
        self.doc.setdefault("textures", []).append({"source": images.index({"uri": uri})})
        return len(self.doc["textures"]) - 1

    def primitive(self, mesh, material):
        attributes = {
            "POSITION": self.accessor(0, mesh.positions, "VEC3", FLOAT, VERTICES, bounds=True),
            "NORMAL": self.accessor(0, mesh.normals, "VEC3", FLOAT, VERTICES)}
        if mesh.texcoords:
            attributes["TEXCOORD_0"] = self.accessor(0, mesh.texcoords, "VEC2", FLOAT, VERTICES)
        corners = [(corner,) for triangle in mesh.triangles for corner in triangle]
        return {"attributes": attributes, "material": material,
                "indices": self.accessor(0, corners, "SCALAR", USHORT, INDICES)}

    def mesh(self, name, mesh, material):
        """mesh, material: one each, or as many of both."""
        meshes, materials = (mesh, material) if isinstance(mesh, list) else ([mesh], [material])
        self.doc["meshes"].append({"name": name, "primitives": [
            self.primitive(*pair) for pair in zip(meshes, materials)]})
        return len(self.doc["meshes"]) - 1

    def node(self, name, parent=None, **members):
        self.doc["nodes"].append({"name": name, **members})
        row = len(self.doc["nodes"]) - 1
        if parent is None:
            self.doc["scenes"][0]["nodes"].append(row)
        else:
            self.doc["nodes"][parent].setdefault("children", []).append(row)
        return row

    def camera(self, name, position, rotation, vertical_field_of_view):
        self.doc["cameras"].append({"type": "perspective", "perspective": {
            "yfov": vertical_field_of_view, "znear": 0.01, "zfar": 10.0}})
        self.node(name, camera=len(self.doc["cameras"]) - 1, translation=position,
                  rotation=rotation)

    def animation(self, name, node, motion):
        """motion: path -> (interpolation, times, values)."""
        samplers, channels = [], []
        for path, (interpolation, times, values) in motion.items():
            kind = "VEC4" if path == "rotation" else "VEC3"
            samplers.append({"interpolation": interpolation,
                             "input": self.accessor(1, [(t,) for t in times], "SCALAR",
                                                    bounds=True),
                             "output": self.accessor(1, values, kind)})
            channels.append({"sampler": len(samplers) - 1, "target": {"node": node, "path": path}})
        self.doc.setdefault("animations", []).append(
            {"name": name, "samplers": samplers, "channels": channels})

    def show(self, title, caption, **keys):
        """How a window shows the scene."""
        self.doc["scenes"][0]["extras"] = {"torsion_title": title, "torsion_caption": caption,
                                           **keys}

    def small_file(self, name):
        """File name -> bytes, of a scene without meshes: all of it in one file."""
        keys = bytes(self.blobs[1].data)
        doc = {key: value for key, value in self.doc.items() if value != []}
        for view in doc["bufferViews"]:
            view["buffer"] = 0
        embedded = "data:application/octet-stream;base64," + base64.b64encode(keys).decode()
        doc["buffers"] = [{"uri": embedded, "byteLength": len(keys)}]
        return {name + ".gltf": (json.dumps(doc, indent=1) + "\n").encode()}

    def files(self, name):
        """File name -> bytes; the meshes are beside the glTF."""
        meshes, keys = (bytes(blob.data) for blob in self.blobs)
        embedded = "data:application/octet-stream;base64," + base64.b64encode(keys).decode()
        self.doc["buffers"] = [{"uri": self.bin_name, "byteLength": len(meshes)},
                               {"uri": embedded, "byteLength": len(keys)}]
        text = json.dumps(self.doc, indent=1) + "\n"
        folder = name[:name.rfind("/") + 1]
        return {name + ".gltf": text.encode(), folder + self.bin_name: meshes}
